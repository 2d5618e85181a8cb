// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

struct lws;

namespace kilolux {

/// Why a page is disconnected for good: a status from 4000 on, of WebSocket's private range, and
/// what page.html shows, at most 123 bytes (RFC 6455, section 5.5).
struct Farewell {
    int status = 0;  // 0: it stays
    std::string_view reason;
};
inline constexpr std::size_t kLongestReason = 123;
inline constexpr int kSessionOver = 4000;
inline constexpr Farewell kNoRoom{
    4001, "Another page drives this session. kilolux view --viewers N lets N others watch."};
inline constexpr Farewell kWrongSecret{
    4002,
    "The address lacks the right secret: open it as it was printed, with all that follows #."};
inline constexpr Farewell kNotUnderstood{4003,
                                         "The server did not understand this page. Load it again."};
inline constexpr Farewell kTooMuch{4004, "This page sent too many messages. Load it again."};
inline constexpr Farewell kReplaced{4005, "A copy of this page has taken its place."};

/// A connected page, as the server's thread sees it.
struct PagePeer {
    using Clock = std::chrono::steady_clock;
    /// Messages a second on average, and at once. A page sends about two for each frame.
    static constexpr double kRate = 600.0;
    static constexpr double kBurst = 1200.0;
    static constexpr double kHelloSeconds = 5.0;  // until its first message

    explicit PagePeer(lws* connection) : wsi(connection) {}

    /// Notes a message; returns whether it is one too many.
    bool is_flooding() {
        const auto now = Clock::now();
        const std::chrono::duration<double> passed = now - counted;
        counted = now;
        allowance = std::min(allowance + kRate * passed.count(), kBurst) - 1.0;
        return allowance < 0.0;
    }
    double seconds_under_way() const {
        return under_way ? std::chrono::duration<double>(Clock::now() - sent_at).count() : 0.0;
    }

    lws* wsi;
    std::string tab;
    bool admitted = false;  // it knew the secret
    Farewell farewell;
    std::string inbox;              // of a message that is not whole yet
    std::deque<std::string> texts;  // to be sent
    std::uint32_t picture = 0;      // number of the last that was sent
    bool under_way = false;         // it is not acknowledged yet
    Clock::time_point sent_at;
    float transport_ms = 0.0f;  // of the last picture: until it was shown
    double allowance = kBurst;
    Clock::time_point counted = Clock::now();
    Clock::time_point came_at = Clock::now();
};

}  // namespace kilolux
