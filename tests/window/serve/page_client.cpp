// SPDX-License-Identifier: Apache-2.0
#include "tests/window/serve/page_client.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_until(Clock::time_point end) {
    return std::chrono::duration<double>(end - Clock::now()).count();
}

Clock::time_point after(double seconds) {
    return Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

// For poll(), rounded up: a wait that ends early would look like a connection that has ended.
int milliseconds(double seconds) {
    return static_cast<int>(std::ceil(1e3 * std::max(seconds, 0.0)));
}

}  // namespace

PageAddress page_address(const std::string& text) {
    const std::size_t host = text.find("//"), fragment = text.find("/#");
    const std::size_t colon = text.rfind(':', fragment);
    if (host == std::string::npos || fragment == std::string::npos || colon <= host + 2) {
        throw std::runtime_error("no address: '" + text + "'");
    }
    return {text.substr(host + 2, colon - host - 2), std::stoi(text.substr(colon + 1)),
            text.substr(fragment + 2, text.find('\n') - fragment - 2)};
}

PageConnection::PageConnection(const PageAddress& address) {
    const bool is_six = address.host == "[::1]";
    sockaddr_in four{};
    sockaddr_in6 six{};
    four.sin_family = AF_INET;
    six.sin6_family = AF_INET6;
    four.sin_port = six.sin6_port = htons(static_cast<std::uint16_t>(address.port));
    six.sin6_addr = in6addr_loopback;
    inet_pton(AF_INET, address.host.c_str(), &four.sin_addr);
    socket_ = ::socket(is_six ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int failed =
        is_six ? connect(socket_, reinterpret_cast<const sockaddr*>(&six), sizeof six)
               : connect(socket_, reinterpret_cast<const sockaddr*>(&four), sizeof four);
    if (failed != 0) {
        const std::string why = std::strerror(errno);
        close(socket_);
        throw std::runtime_error("connect: " + why);
    }
}

PageConnection::~PageConnection() {
    if (socket_ >= 0) close(socket_);
}

PageConnection::PageConnection(PageConnection&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)) {}

PageConnection& PageConnection::operator=(PageConnection&& other) noexcept {
    std::swap(socket_, other.socket_);
    return *this;
}

bool PageConnection::send(const std::string& bytes) const {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
        const ssize_t count =
            ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (count <= 0) return false;
        sent += static_cast<std::size_t>(count);
    }
    return true;
}

std::string PageConnection::receive(double seconds, std::size_t most) {
    pollfd wait{socket_, POLLIN, 0};
    if (poll(&wait, 1, milliseconds(seconds)) <= 0) return "";
    std::string out(most, '\0');
    const ssize_t count = recv(socket_, out.data(), out.size(), 0);
    out.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return out;
}

bool PageConnection::is_closed(double seconds) {
    const auto end = after(seconds);
    while (seconds_until(end) > 0.0) {
        pollfd wait{socket_, POLLIN, 0};
        if (poll(&wait, 1, milliseconds(seconds_until(end))) <= 0) continue;
        char bytes[4096];
        if (recv(socket_, bytes, sizeof bytes, 0) <= 0) return true;
    }
    return false;
}

std::string websocket_request(const PageAddress& address, const std::string& host,
                              const std::string& origin) {
    return fmt::format(
        "GET / HTTP/1.1\r\nHost: {}\r\n{}Upgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Protocol: kilolux\r\n\r\n",
        host.empty() ? fmt::format("{}:{}", address.host, address.port) : host,
        origin.empty() ? "" : "Origin: " + origin + "\r\n");
}

std::string client_frame(int opcode, const std::string& payload, bool final) {
    std::string out(1, static_cast<char>((final ? 0x80 : 0) | opcode));
    const std::size_t size = payload.size();
    if (size < 126) {
        out += static_cast<char>(0x80 | size);
    } else {
        out += static_cast<char>(0x80 | 126);
        out += static_cast<char>(size >> 8);
        out += static_cast<char>(size & 0xff);
    }
    const char mask[] = {17, 34, 51, 68};
    out.append(mask, 4);
    for (std::size_t i = 0; i < size; ++i) out += static_cast<char>(payload[i] ^ mask[i % 4]);
    return out;
}

PageClient::PageClient(const PageAddress& address) : connection_(address) {
    const std::string origin = fmt::format("http://{}:{}", address.host, address.port);
    connection_.send(websocket_request(address, "", origin));
    std::string head;
    while (head.find("\r\n\r\n") == std::string::npos) {
        const std::string more = connection_.receive(20.0);
        if (more.empty()) throw std::runtime_error("no handshake: '" + head + "'");
        head += more;
    }
    if (!head.starts_with("HTTP/1.1 101")) throw std::runtime_error("no WebSocket: " + head);
    waiting_ = head.substr(head.find("\r\n\r\n") + 4);
}

void PageClient::hello(const std::string& secret, const std::string& tab, int width, int height) {
    send(fmt::format(R"(["hello","{}","{}",{},{},1])", secret, tab, width, height));
}

std::optional<PageFrame> PageClient::whole_frame() {
    const auto byte = [this](std::size_t i) {
        return static_cast<std::size_t>(static_cast<unsigned char>(waiting_[i]));
    };
    if (waiting_.size() < 2) return std::nullopt;
    std::size_t head = 2, size = byte(1) & 0x7f;
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (waiting_.size() < head + more) return std::nullopt;
    if (more > 0) size = 0;
    for (std::size_t i = 0; i < more; ++i) size = 256 * size + byte(head + i);
    head += more;
    if (waiting_.size() < head + size) return std::nullopt;
    PageFrame out{static_cast<int>(byte(0) & 0x0f), waiting_.substr(head, size)};
    waiting_.erase(0, head + size);
    return out;
}

std::optional<PageFrame> PageClient::next(double seconds) {
    const auto end = after(seconds);
    while (true) {
        if (const auto frame = whole_frame()) {
            if (frame->opcode != 9) return frame;
            connection_.send(client_frame(10, frame->payload));
            continue;
        }
        const double left = seconds_until(end);
        if (left <= 0.0 || cut_) return std::nullopt;
        const std::string bytes = connection_.receive(left, 1 << 20);
        cut_ = bytes.empty() && seconds_until(end) > 0.0;
        waiting_ += bytes;
    }
}

std::optional<PageFrame> PageClient::next_of(int opcode, double seconds) {
    const auto end = after(seconds);
    while (seconds_until(end) > 0.0) {
        std::optional<PageFrame> frame = next(seconds_until(end));
        if (!frame || frame->opcode == opcode) return frame;
    }
    return std::nullopt;
}

int PageClient::farewell(double seconds) {
    const std::optional<PageFrame> frame = next_of(8, seconds);
    if (!frame) return cut_ ? 1006 : 0;
    if (frame->payload.size() < 2) return 1005;
    return 256 * static_cast<unsigned char>(frame->payload[0]) +
           static_cast<unsigned char>(frame->payload[1]);
}

ReceivedPicture received_picture(const std::optional<PageFrame>& frame) {
    constexpr std::size_t kHead = 17;
    ReceivedPicture out;
    if (!frame) throw std::runtime_error("no picture came");
    const std::string& bytes = frame->payload;
    if (bytes.size() < kHead) throw std::runtime_error("a picture without a head");
    std::memcpy(&out.number, bytes.data(), sizeof out.number);
    out.lossless = bytes[4] == 1;
    out.file = bytes.substr(kHead);
    return out;
}

}  // namespace kilolux
