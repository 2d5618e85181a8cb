// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/picture_buffers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/render/renderer.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

class PictureBuffersTest : public testing::Test {
 protected:
    std::vector<uint> texture() const {
        std::vector<uint> out(static_cast<std::size_t>(buffers_->width() * buffers_->height()));
        glGetTextureImage(buffers_->texture(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                          static_cast<GLsizei>(4 * out.size()), out.data());
        return out;
    }

    GlContext context_ = GlContext::headless();
    std::optional<PictureBuffers> buffers_{std::in_place};
};

TEST_F(PictureBuffersTest, ASlotIsOneUsersUntilItIsReleased) {
    std::set<std::size_t> slots;
    while (const auto slot = buffers_->acquire(100)) slots.insert(*slot);
    EXPECT_EQ(slots.size(), 4u);
    buffers_->release(2);
    EXPECT_EQ(buffers_->acquire(100), 2u);
    EXPECT_EQ(buffers_->acquire(100), std::nullopt);
}

TEST_F(PictureBuffersTest, ASlotGrowsForALargerPicture) {
    const std::size_t slot = buffers_->acquire(10).value();
    buffers_->release(slot);
    ASSERT_EQ(buffers_->acquire(1000), slot);
    EXPECT_EQ(buffers_->pixels(slot).size(), 1000u);
    std::ranges::fill(buffers_->pixels(slot), 7u);
}

TEST_F(PictureBuffersTest, ShowsRowsWithoutTheirPadding) {
    constexpr int kWidth = 21, kHeight = 5;
    const std::size_t stride = display_stride(kWidth);
    ASSERT_GT(stride, std::size_t{kWidth});
    const std::size_t slot = buffers_->acquire(stride * kHeight).value();
    std::vector<uint> expected;
    for (uint y = 0; y < kHeight; ++y) {
        for (uint x = 0; x < stride; ++x) {
            const uint value = 0xff000000u | (y << 8) | x;
            buffers_->pixels(slot)[y * stride + x] = value;
            if (x < kWidth) expected.push_back(value);
        }
    }
    buffers_->show(slot, kWidth, kHeight);
    EXPECT_EQ(buffers_->width(), kWidth);
    EXPECT_EQ(buffers_->height(), kHeight);
    EXPECT_EQ(texture(), expected);
    // It is free again, now or when OpenGL has read it.
    glFinish();
    EXPECT_EQ(buffers_->acquire(1), slot);
}

}  // namespace
}  // namespace kilolux
