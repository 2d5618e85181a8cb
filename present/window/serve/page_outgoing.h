// SPDX-License-Identifier: Apache-2.0
// What the server sends to pages. The functions return what a callback of libwebsockets returns.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "present/window/serve/page_peer.h"
#include "present/window/serve/page_server.h"

namespace kilolux {

/// A message of an image, with room for libwebsockets before it.
struct PageBytes {
    std::uint32_t number = 0;
    std::vector<unsigned char> bytes;
};

/// The message: the picture's number (4 bytes), 1 for PNG or 0 for JPEG (1), when it was drawn in
/// Unix milliseconds (8), how long the page's last one took to be shown in milliseconds (4), the
/// file. Numbers are little-endian.
std::shared_ptr<PageBytes> page_bytes(const PageImage& image);

/// The text of a message of JSON; bytes that are no UTF-8 are replaced.
std::string page_text(const nlohmann::json& message);

/// The beginning of a text that a close frame can hold: UTF-8 of at most kLongestReason bytes.
std::string close_reason(const std::string& text);

/// `transport_ms`: of the page's last picture.
int send_image(lws* wsi, PageBytes& image, float transport_ms);
int send_text(lws* wsi, const std::string& json);
int send_farewell(lws* wsi, const Farewell& farewell);

}  // namespace kilolux
