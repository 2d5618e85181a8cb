// SPDX-License-Identifier: Apache-2.0
#include "raster/gl_context.h"

#include <epoxy/gl.h>

#include "host/base/error.h"
#include "raster/gl_program.h"
#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using GlContextTest = GlTest;

TEST_F(GlContextTest, IsAtLeastFourFiveCore) {
    GLint major = 0;
    GLint minor = 0;
    GLint profile = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_GE(major * 10 + minor, 45) << context_->version();
    EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
    EXPECT_FALSE(context_->renderer().empty());
    EXPECT_FALSE(context_->vendor().empty());
}

TEST_F(GlContextTest, MovesAndComesBack) {
    GlContext second = GlContext::headless();
    GlContext moved(std::move(second));
    context_->make_current();
    const GlBuffer buffer = make_buffer();
    moved.make_current();
    EXPECT_FALSE(glIsBuffer(buffer.name())) << "contexts share objects";
    context_->make_current();
    EXPECT_TRUE(glIsBuffer(buffer.name()));
}

TEST_F(GlContextTest, UnknownPlatformSaysWhatToInstall) {
    try {
        GlContext::headless("device:99");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("device:99"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("libgl1-mesa-dri"), std::string::npos);
    }
    context_->make_current();
}

TEST_F(GlContextTest, FailedCallsAreThrownOnce) {
    EXPECT_NO_THROW(check_gl_errors("nothing"));
    glEnable(GL_TEXTURE_2D + 0x7fff);
    try {
        check_gl_errors("test place");
        FAIL() << "no error";
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_TRUE(what.starts_with("test place: OpenGL: GL_INVALID_ENUM")) << what;
    }
    EXPECT_NO_THROW(check_gl_errors("afterwards"));
}

TEST_F(GlContextTest, ShaderErrorsNameFileAndLine) {
    ShaderText text{GL_FRAGMENT_SHADER, {}};
    text.source.files = {"first.frag", "kernels/shared/second.h"};
    text.source.text = "#version 450 core\n#line 2 0\nvoid main() {\n#line 7 1\n    q = = 1;\n}\n";
    try {
        link_program(std::span(&text, 1));
        FAIL() << "no error";
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_TRUE(what.starts_with("first.frag: does not compile")) << what;
        EXPECT_NE(what.find("kernels/shared/second.h:7"), std::string::npos) << what;
    }
}

}  // namespace
}  // namespace kilolux
