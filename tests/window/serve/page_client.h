// SPDX-License-Identifier: Apache-2.0
// The page's side of `kilolux view --serve` by plain sockets: what a page sends, and what none
// would.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kilolux {

/// A printed address, "http://HOST:PORT/#SECRET".
struct PageAddress {
    std::string host;
    int port = 0;
    std::string secret;
};
/// Throws std::runtime_error.
PageAddress page_address(const std::string& text);

/// A connection to the server.
class PageConnection {
 public:
    /// Throws std::runtime_error where it is refused.
    explicit PageConnection(const PageAddress& address);
    ~PageConnection();
    PageConnection(PageConnection&& other) noexcept;
    PageConnection& operator=(PageConnection&& other) noexcept;

    /// Returns whether the server took all of it.
    bool send(const std::string& bytes) const;
    /// What has come within `seconds`, up to `most` bytes; empty: nothing, or the end.
    std::string receive(double seconds, std::size_t most = 65536);
    /// Whether the server closes it within `seconds`; reads and drops what comes before.
    bool is_closed(double seconds);

 private:
    int socket_ = -1;
};

/// A message of a WebSocket.
struct PageFrame {
    int opcode = 0;  // 1: text, 2: binary, 8: close
    std::string payload;
};

/// The headers of a page's own request for its WebSocket.
std::string websocket_request(const PageAddress& address, const std::string& host,
                              const std::string& origin);

/// A frame as clients send it, masked. `final`: the last of its message.
std::string client_frame(int opcode, const std::string& payload, bool final = true);

/// A page: a WebSocket after its handshake.
class PageClient {
 public:
    /// Throws std::runtime_error where the handshake fails.
    explicit PageClient(const PageAddress& address);

    /// Sends the first message, as a page of that size would.
    void hello(const std::string& secret, const std::string& tab = "tab", int width = 640,
               int height = 400);
    bool send(const std::string& json) const { return connection_.send(client_frame(1, json)); }
    PageConnection& connection() { return connection_; }

    /// The next message, within `seconds`. Answers pings.
    std::optional<PageFrame> next(double seconds);
    /// Skips messages until one of the opcode.
    std::optional<PageFrame> next_of(int opcode, double seconds);
    /// The status of the close that comes within `seconds`; 0: none came. 1006: it was cut.
    int farewell(double seconds);

 private:
    std::optional<PageFrame> whole_frame();

    PageConnection connection_;
    std::string waiting_;  // bytes of frames
    bool cut_ = false;
};

/// The head of a picture's message, see present/window/serve/page_outgoing.h.
struct ReceivedPicture {
    std::uint32_t number = 0;
    bool lossless = false;
    std::string file;
};
ReceivedPicture received_picture(const std::optional<PageFrame>& frame);

}  // namespace kilolux
