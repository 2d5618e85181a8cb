// SPDX-License-Identifier: Apache-2.0
// A driver of OpenGL whose fences are never signalled, as a driver that hangs.
#include <epoxy/gl.h>

#include "host/base/error.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

int wait_count = 0;

GLenum EPOXY_CALLSPEC never_signalled(GLsync, GLbitfield, GLuint64) {
    ++wait_count;
    return GL_TIMEOUT_EXPIRED;
}

// Calls of OpenGL go through variables of libepoxy.
struct HangingDriver {
    HangingDriver() { glClientWaitSync = never_signalled; }
    ~HangingDriver() { glClientWaitSync = real; }
    HangingDriver(const HangingDriver&) = delete;
    HangingDriver& operator=(const HangingDriver&) = delete;
    PFNGLCLIENTWAITSYNCPROC real = glClientWaitSync;
};

TEST(GBufferBridge, GivesUpOnADriverThatHangs) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(32, 18, 10);
    settings.geometry = Geometry::ids;
    Renderer renderer(scene, settings);
    {
        const HangingDriver driver;
        try {
            renderer.render(first_camera(scene), 0.0);
            ADD_FAILURE() << "renders what OpenGL has not drawn";
        } catch (const Error& error) {
            EXPECT_STREQ(error.what(),
                         "gbuffer_bridge: OpenGL has not made a frame in 600 s: its driver hangs");
        }
        EXPECT_EQ(wait_count, 600) << "waits of a second";
    }
    EXPECT_GT(renderer.render(first_camera(scene), 0.0).radiance.size(), 0u);
}

}  // namespace
}  // namespace kilolux
