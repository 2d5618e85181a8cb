// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <string>

struct lws;

namespace kilolux {

/// Why a page is disconnected: a status of WebSocket's private range, which page.html knows.
struct Farewell {
    int status = 0;  // 0: it stays
    const char* reason = "";
};
inline constexpr Farewell kSessionOver{4000, "the session has ended"};
inline constexpr Farewell kNoRoom{4001, "another page drives this session"};
inline constexpr Farewell kWrongSecret{4002, "the address lacks the right secret"};
inline constexpr Farewell kNotUnderstood{4003, "a message was not understood"};
inline constexpr Farewell kTooMuch{4003, "too many messages"};

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
        return under_way ? std::chrono::duration<double>(Clock::now() - sent).count() : 0.0;
    }

    lws* wsi;
    std::string tab;
    bool admitted = false;  // it knew the secret
    Farewell farewell;
    std::string inbox;              // of a message that is not whole yet
    std::deque<std::string> texts;  // to be sent
    std::uint32_t picture = 0;      // number of the last that was sent
    bool under_way = false;         // it is not acknowledged yet
    Clock::time_point sent;
    float transport_ms = 0.0f;  // of the last picture: until it was shown
    double allowance = kBurst;
    Clock::time_point counted = Clock::now();
    Clock::time_point came = Clock::now();
};

}  // namespace kilolux
