// SPDX-License-Identifier: Apache-2.0
#include "present/image/ordered_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr std::size_t kPictures = 40;

void sleep_ms(std::size_t ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// Later pictures are coded faster, so that they wait for the earlier ones.
OrderedWriter::Code coded_late(std::size_t i, std::vector<std::size_t>& out) {
    return [i, &out]() -> OrderedWriter::Write {
        sleep_ms(3 * (3 - i % 4));
        return [i, &out] { out.push_back(i); };
    };
}

std::vector<std::size_t> up_to(std::size_t count) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(i);
    return out;
}

void finish(OrderedWriter& writer) {
    while (writer.wait_for_next()) {
    }
}

TEST(OrderedWriter, WritesInOrderWhateverCodingTakes) {
    for (const std::size_t most : {0u, 1u, 2u, 8u}) {
        std::vector<std::size_t> out;
        OrderedWriter writer(most);
        for (std::size_t i = 0; i < kPictures; ++i) {
            writer.add(coded_late(i, out));
            EXPECT_LE(i + 1 - writer.written(), most) << "held";
        }
        finish(writer);
        EXPECT_EQ(writer.written(), kPictures);
        EXPECT_EQ(out, up_to(kPictures)) << most;
    }
}

TEST(OrderedWriter, WritesWhatItHoldsWhenWorkIsGivenUp) {
    std::vector<std::size_t> out;
    {
        OrderedWriter writer(8);
        for (std::size_t i = 0; i < 5; ++i) writer.add(coded_late(i, out));
    }
    EXPECT_EQ(out, up_to(5));
}

// Adds pictures of which the one `at` fails as `fail` does; returns what was thrown.
std::string failure_of(OrderedWriter& writer, std::size_t at, const OrderedWriter::Code& fail,
                       std::vector<std::size_t>& out) {
    try {
        for (std::size_t i = 0; i < kPictures; ++i) {
            writer.add(i == at ? fail : coded_late(i, out));
        }
        finish(writer);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(OrderedWriter, AFailureIsThrownAndNothingLaterIsWritten) {
    const OrderedWriter::Code coding = []() -> OrderedWriter::Write { throw Error("coding 7"); };
    const OrderedWriter::Code writing = []() -> OrderedWriter::Write {
        return [] { throw Error("writing 7"); };
    };
    for (const std::size_t most : {0u, 3u, 100u}) {
        std::vector<std::size_t> out;
        {
            OrderedWriter writer(most);
            EXPECT_EQ(failure_of(writer, 7, coding, out), "coding 7");
            EXPECT_EQ(writer.written(), 7u);
        }
        EXPECT_EQ(out, up_to(7)) << most;
        out.clear();
        {
            OrderedWriter writer(most);
            EXPECT_EQ(failure_of(writer, 7, writing, out), "writing 7");
            EXPECT_EQ(writer.written(), 7u);
        }
        EXPECT_EQ(out, up_to(7)) << most;
    }
}

TEST(OrderedWriter, WritesNothingAfterItGaveUp) {
    std::vector<std::size_t> out;
    std::atomic<bool> is_given_up = false;
    {
        OrderedWriter writer(8);
        for (std::size_t i = 0; i < 2; ++i) writer.add(coded_late(i, out));
        finish(writer);
        writer.add([&]() -> OrderedWriter::Write {
            while (!is_given_up) sleep_ms(1);
            return [&out] { out.push_back(2); };
        });
        writer.add(coded_late(3, out));
        writer.give_up();
        is_given_up = true;
    }
    EXPECT_EQ(out, up_to(2));
}

// The next picture is made while one is coded: the caller does not wait for the coding.
TEST(OrderedWriter, CodesWhileTheNextPictureIsMade) {
    std::atomic<bool> is_made = false;
    OrderedWriter writer(2);
    std::atomic<bool> waited_in_vain = false;
    writer.add([&]() -> OrderedWriter::Write {
        for (int ms = 0; ms < 20'000 && !is_made; ++ms) sleep_ms(1);
        waited_in_vain = !is_made;
        return [] {};
    });
    is_made = true;
    finish(writer);
    EXPECT_FALSE(waited_in_vain);
    EXPECT_EQ(writer.written(), 1u);
}

}  // namespace
}  // namespace kilolux
