// SPDX-License-Identifier: Apache-2.0
// The server against pages that behave and against clients that do not. Counts say what each may
// cost: after every attack the page that drives still gets its picture.
#include "present/window/serve/page_server.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include <atomic>
#include <fstream>
#include <mutex>
#include <random>
#include <thread>

#include "host/base/error.h"
#include "tests/window/background.h"
#include "tests/window/serve/page_client.h"

namespace kilolux {
namespace {

constexpr double kSoon = 20.0;  // [s], long enough under load

// A server whose session keeps what pages say.
class HeardServer {
 public:
    explicit HeardServer(int viewers = 0)
        : server_({{}, viewers, {}, {}}, "a \"title\"", listener()),
          address_(page_address(server_.address())) {}

    PageServer& operator*() { return server_; }
    PageServer* operator->() { return &server_; }
    const PageAddress& address() const { return address_; }
    std::size_t inputs() const { return inputs_; }
    bool has_driver() const { return driver_; }

    // A page that was let in and knows its role.
    PageClient page(const std::string& tab = "tab", const std::string& role = "driver") {
        PageClient out(address_);
        out.hello(address_.secret, tab);
        const auto welcome = out.next_of(1, kSoon);
        if (!welcome || welcome->payload.find(role) == std::string::npos) {
            throw std::runtime_error("no welcome as " + role);
        }
        return out;
    }
    void show(std::uint32_t number, const std::string& file = "file") {
        server_.show({number,
                      false,
                      0.0,
                      {reinterpret_cast<const unsigned char*>(file.data()), file.size()}});
    }
    // The page that drives sends input and gets pictures: all is well.
    void expect_works(PageClient& page, std::uint32_t number) {
        const std::size_t before = inputs_;
        ASSERT_TRUE(page.send(R"(["move",1,2])"));
        wait_for("input arrives", [&] { return inputs_ > before; });
        show(number, "picture");
        ReceivedPicture picture;
        while (picture.number != number) {  // a new page gets the one before first
            const auto frame = page.next_of(2, kSoon);
            ASSERT_TRUE(frame);
            picture = received_picture(frame);
            page.send(fmt::format(R"(["shown",{}])", picture.number));
        }
        EXPECT_EQ(picture.file, "picture");
        wait_for("the page waits for a picture", [&] { return server_.is_waiting(); });
    }

 private:
    PageListener listener() {
        PageListener out;
        out.message = [this](const PageMessage& message) {
            if (std::holds_alternative<InputMessage>(message)) ++inputs_;
        };
        out.driver = [this](bool here) { driver_ = here; };
        out.ready = [] {};
        return out;
    }

    std::atomic<std::size_t> inputs_ = 0;
    std::atomic<bool> driver_ = false;
    PageServer server_;
    PageAddress address_;
};

// Resident memory [KiB]; 0 where a sanitizer holds back what was freed.
long resident_kib() {
#if defined(__SANITIZE_ADDRESS__)
    return 0;
#endif
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    }
    return 0;
}

std::string answer_to(const PageAddress& address, const std::string& request) {
    PageConnection connection(address);
    connection.send(request);
    std::string out;
    for (std::string more = "-"; !more.empty(); out += more) more = connection.receive(kSoon);
    return out;
}

std::string get(const std::string& path, const std::string& host, const char* method = "GET") {
    return fmt::format("{} {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", method, path,
                       host);
}

TEST(PageServer, SendsOnePageAndNothingElse) {
    HeardServer server;
    const PageAddress& at = server.address();
    const std::string own = fmt::format("127.0.0.1:{}", at.port);
    const std::string page = answer_to(at, get("/", own));
    EXPECT_TRUE(page.starts_with("HTTP/1.1 200")) << page.substr(0, 200);
    EXPECT_NE(page.find("<canvas"), std::string::npos);
    EXPECT_NE(page.find("content-security-policy: default-src 'none'"), std::string::npos);
    EXPECT_EQ(page.find(at.secret), std::string::npos);
    EXPECT_TRUE(page.ends_with("</html>\n"));
    for (const char* path :
         {"/page.html", "/../etc/passwd", "/%2e%2e/etc/passwd", "/favicon.ico"}) {
        EXPECT_TRUE(answer_to(at, get(path, own)).starts_with("HTTP/1.1 4")) << path;
    }
    EXPECT_FALSE(answer_to(at, get("/", own, "POST")).starts_with("HTTP/1.1 200"));
    EXPECT_TRUE(answer_to(at, get("/", "evil.example")).starts_with("HTTP/1.1 403"));
    EXPECT_TRUE(answer_to(at, get("/", "localhost:1")).starts_with("HTTP/1.1 200"));  // ssh -L
}

TEST(PageServer, PagesOfOtherSitesGetNoWebSocket) {
    HeardServer server;
    const PageAddress& at = server.address();
    const std::string own = fmt::format("127.0.0.1:{}", at.port);
    const auto opens = [&](const std::string& host, const std::string& origin) {
        PageConnection connection(at);
        connection.send(websocket_request(at, host, origin));
        return connection.receive(kSoon).starts_with("HTTP/1.1 101");
    };
    EXPECT_TRUE(opens(own, "http://" + own));
    EXPECT_FALSE(opens(own, "http://evil.example"));
    EXPECT_FALSE(opens(own, "http://127.0.0.1:1"));
    EXPECT_FALSE(opens(own, "null"));
    EXPECT_FALSE(opens(own, ""));
    std::string bare = websocket_request(at, own, "http://" + own);
    bare.erase(bare.find("Sec-WebSocket-Protocol"),
               std::string("Sec-WebSocket-Protocol: kilolux\r\n").size());
    PageConnection nameless(at);
    nameless.send(bare);
    EXPECT_FALSE(nameless.receive(kSoon).starts_with("HTTP/1.1 101"));
    // DNS rebinding: the page of evil.example asks this machine in its own name.
    EXPECT_FALSE(opens("evil.example:80", "http://evil.example:80"));
}

TEST(PageServer, OnlyTheSecretOpensIt) {
    HeardServer server;
    for (const std::string& secret :
         {std::string(), std::string(64, '0'), std::string("\\u0000")}) {
        PageClient page(server.address());
        page.hello(secret);
        EXPECT_EQ(page.farewell(kSoon), 4002) << secret;
    }
    PageClient early(server.address());
    early.send(R"(["move",1,2])");
    EXPECT_EQ(early.farewell(kSoon), 4002);
    EXPECT_EQ(server->page_count(), 0);
    EXPECT_EQ(server.inputs(), 0u);
    server.show(1);
    PageClient silent(server.address());
    EXPECT_FALSE(silent.next(1.0));           // no picture without the secret
    EXPECT_EQ(silent.farewell(kSoon), 1006);  // and no place for long
    PageClient page = server.page();
    server.expect_works(page, 2);
}

TEST(PageServer, OnePageDrivesAndOthersWatch) {
    HeardServer server(1);
    PageClient driver = server.page("a");
    PageClient watcher = server.page("b", "watcher");
    PageClient third(server.address());
    third.hello(server.address().secret, "c");
    EXPECT_EQ(third.farewell(kSoon), 4001);
    EXPECT_EQ(server->page_count(), 2);
    watcher.send(R"(["move",1,2])");  // is not obeyed
    server.expect_works(driver, 1);
    EXPECT_EQ(server.inputs(), 1u);
    EXPECT_EQ(received_picture(watcher.next_of(2, kSoon)).number, 1u);
    watcher.send(R"(["shown",1])");
    server->tell_driver(R"({"cursor":"text"})");
    EXPECT_NE(driver.next_of(1, kSoon)->payload.find("cursor"), std::string::npos);
    // The one who watches takes the wheel when it is free.
    driver.connection() = PageConnection(server.address());
    EXPECT_NE(watcher.next_of(1, kSoon)->payload.find("driver"), std::string::npos);
    server.expect_works(watcher, 2);
}

TEST(PageServer, APageThatWasLoadedAgainTakesItsOldPlace) {
    HeardServer server;
    PageClient old = server.page("same");
    server.show(1);
    ASSERT_TRUE(old.next_of(2, kSoon));
    PageClient again = server.page("same");
    EXPECT_EQ(received_picture(again.next_of(2, kSoon)).number, 1u);
    again.send(R"(["shown",1])");
    server.expect_works(again, 2);
    EXPECT_EQ(old.farewell(kSoon), 4005);  // so it does not come again and throw out the new one
    EXPECT_EQ(server->page_count(), 1);
    EXPECT_TRUE(server.has_driver());
}

TEST(PageServer, OnePictureIsUnderWayAndTheNewestFollows) {
    HeardServer server;
    PageClient page = server.page();
    EXPECT_TRUE(server->is_waiting());
    server.show(1);
    ASSERT_EQ(received_picture(page.next_of(2, kSoon)).number, 1u);
    EXPECT_FALSE(server->is_waiting());
    for (std::uint32_t number = 2; number < 50; ++number) server.show(number);
    EXPECT_FALSE(page.next_of(2, 0.5));
    page.send(R"(["shown",7])");  // not the one under way
    EXPECT_FALSE(page.next_of(2, 0.5));
    page.send(R"(["shown",1])");
    EXPECT_EQ(received_picture(page.next_of(2, kSoon)).number, 49u);
    EXPECT_FALSE(page.next_of(2, 0.5));
}

TEST(PageServer, FragmentsAreJoinedAndPingsAnswered) {
    HeardServer server;
    PageClient page = server.page();
    page.connection().send(client_frame(1, R"(["mo)", false) + client_frame(9, "ping") +
                           client_frame(0, R"(ve",1,2])", true));
    wait_for("the move arrives", [&] { return server.inputs() == 1; });
    const auto pong = page.next_of(10, kSoon);
    ASSERT_TRUE(pong);
    EXPECT_EQ(pong->payload, "ping");
    page.send(R"(["alive"])");
    EXPECT_EQ(page.next_of(1, kSoon)->payload, R"({"alive":true})");
}

TEST(PageServer, WhatIsNoMessageEndsTheConnectionOnly) {
    HeardServer server(1);
    PageClient page = server.page();
    const std::vector<std::string> bad = {
        client_frame(1, "no JSON"),
        client_frame(1, R"(["move",1])"),
        client_frame(1, std::string(5000, ' ')),
        client_frame(2, R"(["move",1,2])"),
        client_frame(1, "[\"hello\",\"\xff\xfe\"]"),  // not UTF-8
        client_frame(1, std::string(4000, '[')),
        client_frame(1, "", false) + client_frame(0, std::string(4097, ' ')),
        std::string("\x81\x05hello", 7),                              // not masked
        std::string("\x8f\x80\0\0\0\0", 6),                           // an unknown opcode
        std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff", 10),  // of 2^63 bytes
    };
    for (std::size_t i = 0; i < bad.size(); ++i) {
        PageClient other = server.page("other", "watcher");
        ASSERT_TRUE(other.connection().send(bad[i]));
        EXPECT_NE(other.farewell(kSoon), 0) << i;
        server.expect_works(page, static_cast<std::uint32_t>(i + 1));
    }
    EXPECT_EQ(server.inputs(), bad.size());
}

TEST(PageServer, TooManyMessagesEndTheConnection) {
    HeardServer server;
    PageClient page = server.page();
    std::string flood;
    for (int i = 0; i < 20'000; ++i) flood += client_frame(1, R"(["move",1,2])");
    page.connection().send(flood);
    EXPECT_NE(page.farewell(kSoon), 0);
    EXPECT_LT(server.inputs(), 5'000u);
    PageClient next = server.page("next");
    server.expect_works(next, 1);
}

// Random bytes in place of a request, of a frame, and in a frame.
TEST(PageServer, RandomBytesEndNothing) {
    HeardServer server;
    PageClient page = server.page("driver");
    std::mt19937 random(47);
    const auto noise = [&](std::size_t most) {
        std::string out(random() % most + 1, '\0');
        for (char& c : out) c = static_cast<char>(random());
        return out;
    };
    const PageAddress& at = server.address();
    const std::string own = fmt::format("127.0.0.1:{}", at.port);
    long before = 0;
    for (int i = 0; i < 600; ++i) {
        PageConnection connection(at);
        std::string bytes;
        if (i % 3 > 0) {
            bytes = websocket_request(at, "", "http://" + own);
            if (i % 3 == 1) bytes[random() % bytes.size()] = static_cast<char>(random());
        }
        connection.send(bytes + noise(2000));
        if (i % 3 == 2) connection.send(client_frame(1, noise(100)));
        if (i % 50 == 0) server.expect_works(page, static_cast<std::uint32_t>(i + 1));
        if (i == 100) before = resident_kib();
    }
    server.expect_works(page, 1000);
    EXPECT_LT(resident_kib() - before, 4096);
    EXPECT_EQ(server->page_count(), 1);
}

TEST(PageServer, HalfRequestsAreCutOff) {
    HeardServer server;
    PageClient page = server.page();
    std::vector<PageConnection> halves;
    for (int i = 0; i < 40; ++i) {
        halves.emplace_back(server.address());
        halves.back().send(i % 2 == 0 ? "GET / HT" : "");
    }
    server.expect_works(page, 1);
    // While strangers hold places, the page that drives lost nothing; a new one comes soon.
    int closed = 0;
    for (PageConnection& half : halves) closed += half.is_closed(kSoon);
    EXPECT_EQ(closed, 40);
    PageClient again = server.page();
    server.expect_works(again, 2);
}

TEST(PageServer, AThousandConnectionsGrowNoMemory) {
    HeardServer server;
    PageClient page = server.page();
    const auto connect = [&](int count) {
        std::vector<PageConnection> many;
        for (int i = 0; i < count; ++i) {
            try {
                many.emplace_back(server.address());
                many.back().send("GET / HTTP/1.1\r\n");
            } catch (const std::runtime_error&) {
            }
        }
        server.expect_works(page, static_cast<std::uint32_t>(count));
    };
    connect(100);
    const long before = resident_kib();
    for (const int count : {900, 901, 902}) connect(count);
    EXPECT_LT(resident_kib() - before, 4096);
}

// A page that reads nothing holds one picture, and the others go on.
TEST(PageServer, ASlowPageHoldsOnePicture) {
    HeardServer server(1);
    PageClient page = server.page("a");
    PageClient slow = server.page("b", "watcher");
    const std::string large(2 << 20, 'x');
    server.show(1, large);
    const long before = resident_kib();
    for (std::uint32_t number = 2; number < 30; ++number) {
        const auto frame = page.next_of(2, kSoon);
        ASSERT_TRUE(frame);
        page.send(fmt::format(R"(["shown",{}])", received_picture(frame).number));
        server.show(number, large);
    }
    EXPECT_LT(resident_kib() - before, 16 * 1024);
}

TEST(PageServer, SaysGoodbye) {
    auto server = std::make_unique<HeardServer>(1);
    PageClient driver = server->page("a");
    PageClient watcher = server->page("b", "watcher");
    server.reset();
    EXPECT_EQ(driver.farewell(kSoon), 4000);
    EXPECT_EQ(watcher.farewell(kSoon), 4000);
}

// The one line about a server that cannot be.
void expect_refused(const ServerOptions& options) {
#if defined(__SANITIZE_ADDRESS__)
    const __lsan::ScopedDisabler of_the_library;  // libwebsockets 4.1 frees not all that it made
#endif
    try {
        const PageServer server(options, "", {});
        FAIL() << text_of(options.address);
    } catch (const Error& error) {
        const std::string line = error.what();
        const std::string begin = "--serve: cannot listen at " + text_of(options.address) + ": ";
        EXPECT_TRUE(line.starts_with(begin) && line.size() > begin.size()) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
}

TEST(PageServer, APortThatIsTakenIsALine) {
    HeardServer server;
    ServerOptions options;
    options.address.port = server.address().port;
    expect_refused(options);
}

// Also to pages that come afterwards, in whole characters.
TEST(PageServer, SaysWhyItEnded) {
    HeardServer server;
    PageClient page = server.page();
    const std::string umlauts = "\xff" + [] {
        std::string out;
        for (int i = 0; i < 100; ++i) out += "\xc3\xbc";
        return out;
    }();
    server->end(umlauts);
    const std::string expected = "\xef\xbf\xbd" + umlauts.substr(1, 120);
    for (int i = 0; i < 2; ++i) {
        const auto frame = page.next_of(8, kSoon);
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->payload.substr(2), expected);
        PageClient late(server.address());
        late.hello(server.address().secret);
        page = std::move(late);
    }
}

TEST(PageServer, ListensAtAnIpv6Address) {
    sockaddr_in6 loopback{};
    loopback.sin6_family = AF_INET6;
    loopback.sin6_addr = in6addr_loopback;
    const int probe = ::socket(AF_INET6, SOCK_STREAM, 0);
    const int failed = bind(probe, reinterpret_cast<const sockaddr*>(&loopback), sizeof loopback);
    close(probe);
    if (failed != 0) GTEST_SKIP() << "the machine has no IPv6";
    ServerOptions options;
    options.address.host = "::1";
    const PageServer server(  // the title is no UTF-8
        options, "\xff", PageListener{[](const PageMessage&) {}, [](bool) {}, [] {}});
    const PageAddress address = page_address(server.address());
    ASSERT_EQ(address.host, "[::1]");
    PageClient page(address);
    page.hello(address.secret);
    const auto told = page.next_of(1, kSoon);
    ASSERT_TRUE(told);
    EXPECT_NE(told->payload.find("\xef\xbf\xbd"), std::string::npos) << told->payload;
}

TEST(PageServer, TlsFilesEncryptIt) {
    const TemporaryFolder folder;
    ServerOptions options;
    options.certificate = (folder / "cert.pem").string();
    options.key = (folder / "key.pem").string();
    write_text(options.certificate, "no certificate\n");
    write_text(options.key, "no key\n");
    expect_refused(options);
    ASSERT_EQ(
        run_child({"/usr/bin/env", "openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes",
                   "-days", "2", "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1",
                   "-out", options.certificate, "-keyout", options.key})
            .code,
        0);
    const PageServer server(options, "", {});
    ASSERT_TRUE(server.address().starts_with("https://127.0.0.1:")) << server.address();
    const PageAddress at = page_address(server.address());
    const auto get_page = [&](const std::string& trusted) {
        const std::string client =
            "import ssl, sys, urllib.request as u\n"
            "c = ssl.create_default_context(cafile=sys.argv[2] or None)\n"
            "print(u.urlopen(sys.argv[1], context=c, timeout=20).read().decode())\n";
        const std::string url = fmt::format("https://127.0.0.1:{}/", at.port);
        return run_child({"/usr/bin/env", "python3", "-c", client, url, trusted}).out;
    };
    EXPECT_NE(get_page(options.certificate).find("<canvas"), std::string::npos);
    EXPECT_EQ(get_page("").find("<canvas"), std::string::npos);
    const std::string plain = answer_to(at, get("/", fmt::format("127.0.0.1:{}", at.port)));
    EXPECT_EQ(plain.find("<canvas"), std::string::npos) << plain;
    EXPECT_NE(get_page(options.certificate).find("<canvas"), std::string::npos);
}

}  // namespace
}  // namespace kilolux
