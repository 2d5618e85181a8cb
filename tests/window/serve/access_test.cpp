// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/access.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <set>

#include "host/base/error.h"

namespace kilolux {
namespace {

TEST(ServeAccess, AddressesAreParsedAndWrittenBack) {
    const auto parsed = [](const std::string& text) {
        return parse_serve_address("--serve", text);
    };
    EXPECT_EQ(parsed(""), ServeAddress{});
    EXPECT_EQ(parsed("local"), (ServeAddress{"127.0.0.1", 0}));
    EXPECT_EQ(parsed("127.0.0.1:8080"), (ServeAddress{"127.0.0.1", 8080}));
    EXPECT_EQ(parsed("localhost:8080"), (ServeAddress{"127.0.0.1", 8080}));
    EXPECT_EQ(parsed("0.0.0.0"), (ServeAddress{"0.0.0.0", 0}));
    EXPECT_EQ(parsed("[::1]:65535"), (ServeAddress{"::1", 65535}));
    for (const char* text : {"127.0.0.1:0", "10.1.2.3:80", "[fe80::1]:8080"}) {
        EXPECT_EQ(text_of(parsed(text)), text);
    }
    for (const char* text : {"atrium", "8080", ":8080", "127.0.0.1:65536", "127.0.0.1:-1", "::1:80",
                             "[::1", "[::1]8080", "127.0.0.1:", "1.2.3:80", "example.com:80"}) {
        EXPECT_THROW(parsed(text), UsageError) << text;
    }
}

TEST(ServeAccess, OnlyLoopbackIsLocal) {
    EXPECT_TRUE(is_loopback({"127.0.0.1", 1}));
    EXPECT_TRUE(is_loopback({"::1", 1}));
    EXPECT_FALSE(is_loopback({"0.0.0.0", 1}));
    EXPECT_FALSE(is_loopback({"::", 1}));
    EXPECT_FALSE(is_loopback({"10.0.0.1", 1}));
}

TEST(ServeAccess, SecretsAreLongAndDiffer) {
    std::set<std::string> seen;
    for (int i = 0; i < 100; ++i) seen.insert(make_secret());
    EXPECT_EQ(seen.size(), 100u);
    for (const std::string& secret : seen) {
        EXPECT_EQ(secret.size(), 64u);
        EXPECT_EQ(secret.find_first_not_of("0123456789abcdef"), std::string::npos);
    }
}

TEST(ServeAccess, OnlyTheWholeSecretIsTheSame) {
    const std::string secret = make_secret();
    EXPECT_TRUE(same_secret(secret, std::string(secret)));
    EXPECT_FALSE(same_secret(secret, ""));
    EXPECT_FALSE(same_secret(secret, secret + "0"));
    EXPECT_FALSE(same_secret(secret.substr(1), secret));
    for (std::size_t i = 0; i < secret.size(); ++i) {
        std::string other = secret;
        other[i] = other[i] == '0' ? '1' : '0';
        EXPECT_FALSE(same_secret(secret, other)) << i;
    }
}

TEST(ServeAccess, HostsOfOtherSitesAreRefused) {
    for (const char* host : {"127.0.0.1", "127.0.0.1:80", "localhost:4000", "LOCALHOST", "[::1]:80",
                             "10.0.0.7:9999"}) {
        EXPECT_TRUE(is_allowed_host(host)) << host;
    }
    char name[256] = {};
    ASSERT_EQ(gethostname(name, sizeof name - 1), 0);
    EXPECT_TRUE(is_allowed_host(name));
    EXPECT_TRUE(is_allowed_host(std::string(name) + ".local:80"));
    // Anybody can register a name that resolves to this machine.
    EXPECT_FALSE(is_allowed_host(std::string(name) + ".evil.example"));
    for (const char* host :
         {"", "evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost.evil.example",
          "[::1.evil", "[", "]", ":", "127.0.0.1@evil"}) {
        EXPECT_FALSE(is_allowed_host(host)) << host;
    }
}

TEST(ServeAccess, OriginsOfOtherPagesAreRefused) {
    EXPECT_TRUE(is_same_origin("http://127.0.0.1:80", "127.0.0.1:80"));
    EXPECT_TRUE(is_same_origin("https://LocalHost:80", "localhost:80"));
    for (const char* origin :
         {"", "null", "127.0.0.1:80", "http://127.0.0.1:81", "http://localhost:80",
          "http://127.0.0.1:80/", "http://evil.example", "file://127.0.0.1:80"}) {
        EXPECT_FALSE(is_same_origin(origin, "127.0.0.1:80")) << origin;
    }
}

}  // namespace
}  // namespace kilolux
