// SPDX-License-Identifier: Apache-2.0
// Requests of HTTP: there is one page. What they return is what a callback of libwebsockets
// returns.
#pragma once

#include <string_view>

struct lws;

namespace kilolux {

/// Whether a WebSocket's request names an allowed host, and comes from the page that was served
/// under it.
bool comes_from_page(lws* wsi);

/// Sends the head of the page for "/", and asks to be called for its text; refuses all else.
int answer_request(lws* wsi, std::string_view path, std::string_view page);

/// Sends the page's text.
int send_page(lws* wsi, std::string_view page);

}  // namespace kilolux
