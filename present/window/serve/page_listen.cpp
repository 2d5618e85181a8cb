// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/page_listen.h"

#include <arpa/inet.h>
#include <libwebsockets.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "host/base/error.h"

namespace kilolux {
namespace {

// A connection without a sign of life is asked for one, then closed [s].
constexpr lws_retry_bo_t kPing = {nullptr, 0, 0, 15, 40, 0};

std::string& last_complaint() {
    thread_local std::string text;
    return text;
}

void note_complaint(int, const char* line) {
    last_complaint() = line;
    while (last_complaint().ends_with('\n')) last_complaint().pop_back();
}

Error cannot_listen(const ServeAddress& address, const std::string& reason) {
    return Error("--serve: cannot listen at " + text_of(address) + ": " + reason);
}

// libwebsockets waits without a word for an address that the machine does not have.
void check_is_own(const ServeAddress& address) {
    sockaddr_in6 six{};
    sockaddr_in four{};
    six.sin6_family = AF_INET6;
    four.sin_family = AF_INET;
    const bool is_six = inet_pton(AF_INET6, address.host.c_str(), &six.sin6_addr) == 1;
    if (!is_six) inet_pton(AF_INET, address.host.c_str(), &four.sin_addr);
    const int probe = socket(is_six ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (probe < 0) throw cannot_listen(address, std::strerror(errno));
    const int failed = is_six ? bind(probe, reinterpret_cast<const sockaddr*>(&six), sizeof six)
                              : bind(probe, reinterpret_cast<const sockaddr*>(&four), sizeof four);
    const int reason = errno;
    close(probe);
    if (failed != 0) throw cannot_listen(address, std::strerror(reason));
}

}  // namespace

lws_context* listen_for_pages(const ServerOptions& options, const lws_protocols* protocols,
                              void* user) {
    check_is_own(options.address);
    lws_context_creation_info info{};
    info.iface = options.address.host.c_str();
    info.port = options.address.port;
    info.protocols = protocols;
    info.user = user;
    info.retry_and_idle_policy = &kPing;
    info.fd_limit_per_thread = PageServer::kMostConnections + 16;  // and those of the loop itself
    info.max_http_header_data = 4096;
    info.timeout_secs = 5;          // of a request until it is whole
    info.timeout_secs_ah_idle = 5;  // of its memory
    info.keepalive_timeout = 5;
    info.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND | LWS_SERVER_OPTION_VALIDATE_UTF8;
    if (!options.certificate.empty()) {
        info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
        info.ssl_cert_filepath = options.certificate.c_str();
        info.ssl_private_key_filepath = options.key.c_str();
        info.alpn = "http/1.1";
    }
    lws_set_log_level(LLL_ERR, note_complaint);
    last_complaint().clear();
    errno = 0;
    lws_context* const context = lws_create_context(&info);
    if (context != nullptr) return context;
    const std::string system = errno != 0 ? std::strerror(errno) : "no reason given";
    throw cannot_listen(options.address, last_complaint().empty() ? system : last_complaint());
}

}  // namespace kilolux
