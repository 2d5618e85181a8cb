// SPDX-License-Identifier: Apache-2.0
#include "present/image/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "present/cli/names.h"
#include "present/image/image_file.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

Frame make_frame(int width, int height, float value) {
    Frame frame;
    frame.width = width;
    frame.height = height;
    const auto pixels = static_cast<std::size_t>(width * height);
    frame.radiance.assign(3 * pixels, value);
    frame.display.assign(4 * pixels, 100);
    return frame;
}

double error_of(const Comparison& comparison, const std::string& metric) {
    for (const auto& [name, value] : comparison.errors) {
        if (name == metric) return value;
    }
    ADD_FAILURE() << "no metric " << metric;
    return -1.0;
}

TEST(Comparison, EqualPicturesPassAtZero) {
    const TemporaryFolder folder;
    const Frame frame = make_frame(4, 3, 0.7f);
    for (const char* name : {"r.exr", "r.png"}) {
        write_image(folder / name, frame);
        for (const std::string& metric : metric_choices().names) {
            const Comparison same = Reference(folder / name).compare(frame, metric, 0.0);
            EXPECT_EQ(same.value, 0.0) << name << " " << metric;
            EXPECT_TRUE(same.passed()) << name << " " << metric;
        }
    }
}

TEST(Comparison, MetricsOfOneWrongValue) {
    const TemporaryFolder folder;
    Frame frame = make_frame(4, 3, 1.0f);
    write_image(folder / "r.exr", frame);
    frame.radiance[7] += 0.5f;
    const Reference reference(folder / "r.exr");
    const Comparison c = reference.compare(frame, "rmse", 0.1);
    EXPECT_NEAR(error_of(c, "rmse"), std::sqrt(0.25 / 36.0), 1e-12);
    EXPECT_NEAR(error_of(c, "mean"), 0.5 / 36.0, 1e-12);
    EXPECT_EQ(error_of(c, "max"), 0.5);
    EXPECT_EQ(error_of(c, "max-relative"), 0.5);
    EXPECT_EQ(error_of(c, "different-pixels"), 1.0);
    EXPECT_TRUE(c.passed());
    EXPECT_FALSE(reference.compare(frame, "rmse", 0.08).passed());
    EXPECT_FALSE(reference.compare(frame, "max", 0.49).passed());
    EXPECT_TRUE(reference.compare(frame, "different-pixels", 1.0).passed());
}

TEST(Comparison, FlipSeesWhatAnObserverSees) {
    const TemporaryFolder folder;
    Frame frame = make_frame(24, 24, 0.5f);
    for (const char* name : {"r.exr", "r.png"}) write_image(folder / name, frame);
    for (std::size_t i = 0; i < frame.radiance.size(); i += 2) frame.radiance[i] = 0.05f;
    for (std::size_t i = 0; i < frame.display.size(); i += 2) frame.display[i] = 20;
    for (const char* name : {"r.exr", "r.png"}) {
        const double flip = Reference(folder / name).compare(frame, "flip", 0.0).value;
        EXPECT_GT(flip, 0.1) << name;
        EXPECT_LE(flip, 1.0) << name;
    }
}

TEST(Comparison, WhatIsNotFiniteNeverPasses) {
    const TemporaryFolder folder;
    Frame frame = make_frame(4, 3, 1.0f);
    write_image(folder / "r.exr", frame);
    frame.radiance[7] = std::numeric_limits<float>::quiet_NaN();
    const Reference reference(folder / "r.exr");
    for (const std::string metric : {"rmse", "mean", "max"}) {
        EXPECT_FALSE(reference.compare(frame, metric, 1e300).passed()) << metric;
    }
}

TEST(Comparison, DisplayReferencesCompareCodes) {
    const TemporaryFolder folder;
    Frame frame = make_frame(4, 3, 1.0f);
    write_image(folder / "r.png", frame);
    frame.radiance.assign(frame.radiance.size(), 9.0f);  // a PNG is compared with `display`
    frame.display[0] += 2;
    frame.display[3] = 0;  // alpha
    const Comparison c = Reference(folder / "r.png").compare(frame, "max", 0.0);
    EXPECT_NEAR(c.value, 2.0 / 255.0, 1e-7);
    EXPECT_EQ(error_of(c, "different-pixels"), 1.0);
}

TEST(Comparison, SizesMustAgree) {
    const TemporaryFolder folder;
    write_image(folder / "r.exr", make_frame(4, 3, 1.0f));
    const Reference reference(folder / "r.exr");
    const auto message =
        message_of<Error>([&] { reference.compare(make_frame(3, 4, 1.0f), "max", 0.0); });
    EXPECT_TRUE(contains(message, "4x3")) << message;
    EXPECT_TRUE(contains(message, "3x4")) << message;
}

TEST(Comparison, TheSizeIsAskedOfTheHeader) {
    const TemporaryFolder folder;
    write_image(folder / "r.exr", make_frame(4, 3, 1.0f));
    EXPECT_NO_THROW(require_reference_size(folder / "r.exr", 4, 3));
    EXPECT_EQ(message_of<Error>([&] { require_reference_size(folder / "r.exr", 3, 4); }),
              (folder / "r.exr").string() + ": the reference is 4x3 pixels, the picture 3x4");
}

TEST(Comparison, TheDifferenceIsAPictureOfEveryPixelsError) {
    const TemporaryFolder folder;
    Frame frame = make_frame(4, 3, 1.0f);
    write_image(folder / "r.exr", frame);
    frame.radiance[7] += 0.5f;
    frame.radiance[8] -= 0.25f;
    const Frame difference = Reference(folder / "r.exr").difference(frame);
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
        EXPECT_EQ(difference.radiance[i], i == 7 ? 0.5f : i == 8 ? 0.25f : 0.0f) << i;
    }
    const auto color = [&](std::size_t pixel) {
        return std::vector(difference.display.begin() + static_cast<std::ptrdiff_t>(4 * pixel),
                           difference.display.begin() + static_cast<std::ptrdiff_t>(4 * pixel + 4));
    };
    EXPECT_NE(color(2), color(0));
    for (std::size_t pixel = 3; pixel < 12; ++pixel) EXPECT_EQ(color(pixel), color(0)) << pixel;
}

}  // namespace
}  // namespace kilolux
