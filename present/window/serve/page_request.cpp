// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/page_request.h"

#include <libwebsockets.h>

#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "present/window/serve/access.h"

namespace kilolux {
namespace {

// The page needs its own script and style, and this server; not all browsers take 'self' for
// WebSockets (w3c/webappsec-csp#7).
constexpr std::pair<const char*, const char*> kHeaders[] = {
    {"content-security-policy:",
     "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
     "connect-src 'self' ws: wss:; base-uri 'none'; form-action 'none'"},
    {"x-content-type-options:", "nosniff"},
    {"referrer-policy:", "no-referrer"},
    {"cache-control:", "no-store"}};

std::string header_of(lws* wsi, lws_token_indexes token) {
    std::array<char, 512> out{};
    const int length = lws_hdr_copy(wsi, out.data(), static_cast<int>(out.size()), token);
    return length > 0 ? std::string(out.data(), static_cast<std::size_t>(length)) : "";
}

}  // namespace

bool comes_from_page(lws* wsi) {
    const std::string host = header_of(wsi, WSI_TOKEN_HOST);
    return is_allowed_host(host) && is_same_origin(header_of(wsi, WSI_TOKEN_ORIGIN), host);
}

int answer_request(lws* wsi, std::string_view path, std::string_view page) {
    const auto refuse = [wsi](unsigned status, const char* why) {
        lws_return_http_status(wsi, status, why);
        return -1;
    };
    if (!is_allowed_host(header_of(wsi, WSI_TOKEN_HOST))) {
        return refuse(HTTP_STATUS_FORBIDDEN, "Name this machine by its address or its own name.");
    }
    if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) == 0) {
        return refuse(HTTP_STATUS_METHOD_NOT_ALLOWED, "Only GET is answered.");
    }
    if (path != "/") return refuse(HTTP_STATUS_NOT_FOUND, "There is one page.");
    std::array<unsigned char, LWS_PRE + 2048> head{};
    unsigned char* const begin = head.data() + LWS_PRE;
    unsigned char* end = begin;
    unsigned char* const most = head.data() + head.size() - 1;
    if (lws_add_http_common_headers(wsi, HTTP_STATUS_OK, "text/html; charset=utf-8", page.size(),
                                    &end, most) != 0) {
        return -1;
    }
    for (const auto& [name, value] : kHeaders) {
        if (lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name),
                                        reinterpret_cast<const unsigned char*>(value),
                                        static_cast<int>(std::strlen(value)), &end, most) != 0) {
            return -1;
        }
    }
    if (lws_finalize_write_http_header(wsi, begin, &end, most) != 0) return -1;
    lws_callback_on_writable(wsi);
    return 0;
}

int send_page(lws* wsi, std::string_view page) {
    std::vector<unsigned char> out(LWS_PRE + page.size());
    std::memcpy(out.data() + LWS_PRE, page.data(), page.size());
    if (lws_write(wsi, out.data() + LWS_PRE, page.size(), LWS_WRITE_HTTP_FINAL) < 0) return -1;
    return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

}  // namespace kilolux
