// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/access.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <sys/random.h>
#include <unistd.h>

#include <array>

#include "host/base/error.h"
#include "host/base/text.h"
#include "present/cli/option_values.h"

namespace kilolux {
namespace {

bool is_address(int family, const std::string& text) {
    std::array<unsigned char, sizeof(in6_addr)> out{};
    return inet_pton(family, text.c_str(), out.data()) == 1;
}

// A Host header's name without its port, and without the brackets of an IPv6 address.
std::string name_of_host(std::string_view host) {
    if (host.starts_with('[')) return std::string(host.substr(1, host.find(']') - 1));
    return lower(std::string(host.substr(0, host.find(':'))));
}

std::string machine_name() {
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) != 0) return "";
    return lower(name.data());
}

// The machine's name with its domain, as the system knows it; empty: it knows none.
std::string domain_name(const std::string& machine) {
    addrinfo wanted{};
    wanted.ai_flags = AI_CANONNAME;
    addrinfo* found = nullptr;
    if (getaddrinfo(machine.c_str(), nullptr, &wanted, &found) != 0) return "";
    const std::string out = found->ai_canonname != nullptr ? lower(found->ai_canonname) : "";
    freeaddrinfo(found);
    return out;
}

std::string in_brackets(const std::string& host) {
    return is_address(AF_INET6, host) ? "[" + host + "]" : host;
}

}  // namespace

ServeAddress parse_serve_address(const std::string& name, const std::string& text) {
    ServeAddress out;
    if (text.empty() || text == "local") return out;
    const auto fail = [&] {
        return UsageError(
            name + ": '" + text +
            "' is not ADDRESS:PORT, as 127.0.0.1:8080 or [::1]:8080, nor 'local'; SCENE "
            "stands before --serve");
    };
    const bool brackets = text.starts_with('[');
    const std::size_t end = brackets ? text.find(']') : text.rfind(':');
    if (brackets && end == std::string::npos) throw fail();
    const std::size_t colon = brackets ? end + 1 : end;
    out.host = brackets ? text.substr(1, end - 1) : text.substr(0, end);
    if (out.host == "localhost") out.host = "127.0.0.1";
    if (!is_address(brackets ? AF_INET6 : AF_INET, out.host)) throw fail();
    if (colon >= text.size()) return out;
    if (text[colon] != ':') throw fail();
    out.port = static_cast<int>(parse_count(name, text.substr(colon + 1), {0, 65535}));
    return out;
}

std::string text_of(const ServeAddress& address) {
    return fmt::format("{}:{}", in_brackets(address.host), address.port);
}

bool is_loopback(const ServeAddress& address) {
    return address.host.starts_with("127.") || address.host == "::1";
}

std::string host_in_url(const ServeAddress& address) {
    if (address.host == "0.0.0.0" || address.host == "::") return machine_name();
    return in_brackets(address.host);
}

std::string make_secret() {
    std::array<unsigned char, 32> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        throw Error("--serve: the system has no random numbers for the address's secret");
    }
    std::string out;
    for (const unsigned char byte : bytes) out += fmt::format("{:02x}", byte);
    return out;
}

bool same_secret(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    // A compiler may not leave the loop early: it must not know that the result is all that counts.
    volatile unsigned char difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference = static_cast<unsigned char>(
            difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
    }
    return difference == 0;
}

bool is_allowed_host(std::string_view host) {
    const std::string name = name_of_host(host);
    if (name == "localhost" || is_address(AF_INET, name) || is_address(AF_INET6, name)) return true;
    const std::string own = machine_name();
    if (own.empty() || !name.starts_with(own)) return false;  // no resolver is asked of others
    if (name == own || name == own + ".local") return true;
    static const std::string whole = domain_name(own);
    return name == whole;
}

bool is_same_origin(std::string_view origin, std::string_view host) {
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (origin.starts_with(scheme))
            return lower(std::string(origin.substr(scheme.size()))) == lower(std::string(host));
    }
    return false;
}

}  // namespace kilolux
