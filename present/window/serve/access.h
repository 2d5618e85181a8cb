// SPDX-License-Identifier: Apache-2.0
// Who may see and control a served screen.
#pragma once

#include <string>
#include <string_view>

namespace kilolux {

/// Where a server listens.
struct ServeAddress {
    std::string host = "127.0.0.1";  // an IPv4 or IPv6 address
    int port = 0;                    // 0: a free one
    bool operator==(const ServeAddress&) const = default;
};

/// "ADDRESS:PORT", "ADDRESS" or "local", which is ServeAddress{}; an IPv6 address stands in
/// brackets. Throws UsageError with the option's name.
ServeAddress parse_serve_address(const std::string& name, const std::string& text);

/// The text that parse_serve_address() takes.
std::string text_of(const ServeAddress& address);

/// Whether only this machine's programs reach it.
bool is_loopback(const ServeAddress& address);

/// The host for a URL: an IPv6 address in brackets; the machine's name for 0.0.0.0 and [::].
std::string host_in_url(const ServeAddress& address);

/// 64 hexadecimal digits from the system's random numbers. Throws Error.
std::string make_secret();

/// Whether both are equal. The time taken does not depend on where they differ.
bool same_secret(std::string_view a, std::string_view b);

/// Whether a request may name this host ("localhost:8080"): an address, localhost or the machine's
/// own name, alone, with its domain or ".local". A page of another site whose name was made to
/// resolve to this machine (DNS rebinding) sends that site's name.
bool is_allowed_host(std::string_view host);

/// Whether a request's Origin is the page that this server sent under that Host.
bool is_same_origin(std::string_view origin, std::string_view host);

}  // namespace kilolux
