// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/page_outgoing.h"

#include <libwebsockets.h>

#include <cstring>
#include <nlohmann/json.hpp>

namespace kilolux {
namespace {

// Bytes of an image's message.
constexpr std::size_t kKindAt = 4;
constexpr std::size_t kMadeAt = 5;
constexpr std::size_t kTransportAt = 13;
constexpr std::size_t kFileAt = 17;

void copy_to(std::vector<unsigned char>& out, std::size_t at, const void* value, std::size_t size) {
    std::memcpy(out.data() + LWS_PRE + at, value, size);
}

int write_message(lws* wsi, unsigned char* begin, std::size_t size, lws_write_protocol kind) {
    // What the connection does not take at once, libwebsockets copies.
    return lws_write(wsi, begin, size, kind) < 0 ? -1 : 0;
}

}  // namespace

std::shared_ptr<PageBytes> page_bytes(const PageImage& image) {
    auto out = std::make_shared<PageBytes>();
    out->number = image.number;
    out->bytes.resize(LWS_PRE + kFileAt);
    const unsigned char kind = image.lossless ? 1 : 0;
    copy_to(out->bytes, 0, &image.number, sizeof image.number);
    copy_to(out->bytes, kKindAt, &kind, sizeof kind);
    copy_to(out->bytes, kMadeAt, &image.made_ms, sizeof image.made_ms);
    out->bytes.insert(out->bytes.end(), image.file.begin(), image.file.end());
    return out;
}

std::string page_text(const nlohmann::json& message) {
    return message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string close_reason(const std::string& text) {
    std::string out = nlohmann::json::parse(page_text(text)).get<std::string>();
    if (out.size() <= kLongestReason) return out;
    std::size_t end = kLongestReason;
    while ((out[end] & 0xc0) == 0x80) --end;  // within a character
    return out.substr(0, end);
}

int send_image(lws* wsi, PageBytes& image, float transport_ms) {
    copy_to(image.bytes, kTransportAt, &transport_ms, sizeof transport_ms);
    return write_message(wsi, image.bytes.data() + LWS_PRE, image.bytes.size() - LWS_PRE,
                         LWS_WRITE_BINARY);
}

int send_text(lws* wsi, const std::string& json) {
    std::string out = std::string(LWS_PRE, '\0') + json;
    return write_message(wsi, reinterpret_cast<unsigned char*>(out.data()) + LWS_PRE, json.size(),
                         LWS_WRITE_TEXT);
}

int send_farewell(lws* wsi, const Farewell& farewell) {
    std::string reason(farewell.reason);
    lws_close_reason(wsi, static_cast<lws_close_status>(farewell.status),
                     reinterpret_cast<unsigned char*>(reason.data()), reason.size());
    return -1;
}

}  // namespace kilolux
