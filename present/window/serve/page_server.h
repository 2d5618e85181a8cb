// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "present/window/serve/access.h"
#include "present/window/serve/page_messages.h"

namespace kilolux {

struct ServerOptions {
    ServeAddress address;
    int viewers = 0;  // pages beside the one that drives
    // Files of TLS, PEM; empty: http.
    std::string certificate;
    std::string key;
    bool operator==(const ServerOptions&) const = default;
};

/// A picture for pages: a file in memory.
struct PageImage {
    std::uint32_t number = 0;  // larger ones are newer
    bool lossless = false;     // PNG, else JPEG
    double made_ms = 0.0;      // when it was drawn, Unix time
    std::span<const unsigned char> file;
};

/// What pages do. Called in the server's thread.
struct PageListener {
    std::function<void(PageMessage)> message;  // of the page that drives
    std::function<void(bool here)> driver;     // another page drives now, or none
    std::function<void()> ready;               // a page can take a picture
};

/// Serves the page and the messages between pages and a session, by libwebsockets in a thread of
/// its own. The page is public; it shows and drives nothing before its first message has named the
/// secret, which stands in the address's fragment: browsers send that in no request. The first page
/// drives, others watch. A page that sends what is no message, or too much, is disconnected.
class PageServer {
 public:
    /// Pictures that are not acknowledged for so long end a page's connection [s].
    static constexpr double kPatienceSeconds = 30.0;
    /// Connections at once, of whatever kind.
    static constexpr int kMostConnections = 64;

    /// Listens from now on. `title`: of the page. Throws Error with the system's reason.
    PageServer(const ServerOptions& options, const std::string& title, PageListener listener);
    /// Says goodbye as end() does.
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// The address to open, with the secret.
    const std::string& address() const;

    // From any thread:

    /// Pages that may see pictures.
    int page_count() const;
    /// Whether a page has no picture under way.
    bool is_waiting() const;
    /// Sends the image to each page that waits, else when it does, unless a newer one came.
    void show(const PageImage& image);
    /// Sends a JSON object to the page that drives.
    void tell_driver(const std::string& json);
    /// Tells pages that the session is over, and why, and disconnects them.
    void end(const std::string& reason = "");

 private:
    class Loop;
    std::unique_ptr<Loop> loop_;
};

}  // namespace kilolux
