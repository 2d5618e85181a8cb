// SPDX-License-Identifier: Apache-2.0
// Every OpenCL call that a frame makes fails once, by a layer between loader and driver
// (layer/fault_layer.cpp): one line says which, and the next frame is right again.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <random>

#include "host/base/error.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

class FaultLayer {
 public:
    FaultLayer() : library_(dlopen(KILOLUX_FAULT_LAYER, RTLD_NOW | RTLD_NOLOAD)) {
        if (library_ == nullptr) return;
        arm_ = reinterpret_cast<void (*)(int, int)>(dlsym(library_, "fault_layer_arm"));
        calls_ = reinterpret_cast<int (*)()>(dlsym(library_, "fault_layer_calls"));
    }
    ~FaultLayer() {
        if (library_ == nullptr) return;
        arm_(0, 0);
        dlclose(library_);
    }
    FaultLayer(const FaultLayer&) = delete;
    FaultLayer& operator=(const FaultLayer&) = delete;
    bool loaded() const { return library_ != nullptr; }
    void arm(int call, int code) const { arm_(call, code); }
    int calls() const { return calls_(); }

 private:
    void* library_;
    void (*arm_)(int, int) = nullptr;
    int (*calls_)() = nullptr;
};

// Loads OpenCL, and with it the layer.
void start_opencl() { choose_device(""); }

RenderSettings faulty_settings() {
    RenderSettings settings = small_settings(64, 48, 200);
    settings.opened = nullptr;  // each renderer makes all calls
    settings.bloom = 0.2f;
    settings.want.aovs = {"depth", "light-count"};
    settings.want.counts = true;
    return settings;
}

// "" when the frame was made.
std::string error_of_frame(Renderer& renderer, const Camera& camera, Frame& frame) {
    try {
        frame = renderer.render(camera, 0.0);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

struct Fault {
    int code;
    const char* name;
};
constexpr Fault kFaults[] = {{CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
                             {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES"},
                             {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE"}};

TEST(OpenClFaults, EveryCallOfAFrameMayFail) {
    start_opencl();
    const FaultLayer layer;
    ASSERT_TRUE(layer.loaded()) << "OPENCL_LAYERS names no " << KILOLUX_FAULT_LAYER;
    const Scene scene = make_generated_scene("plain");
    const Camera camera = first_camera(scene);
    Renderer renderer(scene, faulty_settings());
    layer.arm(0, 0);
    const Frame right = renderer.render(camera, 0.0);
    layer.arm(0, 0);
    renderer.render(camera, 0.0);
    const int calls = layer.calls();
    ASSERT_GT(calls, 50);
    for (int call = 1; call <= calls; ++call) {
        const Fault& fault = kFaults[call % 3];
        SCOPED_TRACE("call " + std::to_string(call) + " of " + std::to_string(calls));
        layer.arm(call, fault.code);
        Frame frame;
        const std::string error = error_of_frame(renderer, camera, frame);
        EXPECT_NE(error.find(fault.name), std::string::npos) << "'" << error << "'";
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        layer.arm(0, 0);
        ASSERT_EQ(error_of_frame(renderer, camera, frame), "");
        ASSERT_EQ(frame.radiance, right.radiance);
        ASSERT_EQ(frame.display, right.display);
    }
}

// A context may be unusable once a call has failed.
TEST(OpenClFaults, OtherSettingsOpenADeviceThatFailedAnew) {
    start_opencl();
    const FaultLayer layer;
    ASSERT_TRUE(layer.loaded());
    const Scene scene = make_generated_scene("plain");
    const Camera camera = first_camera(scene);
    RenderSettings lambert = faulty_settings(), pbr = faulty_settings();
    lambert.shading = Shading::lambert;
    pbr.shading = Shading::pbr;
    layer.arm(0, 0);
    Renderer renderer(scene, lambert);
    const Frame right = renderer.render(camera, 0.0);
    const cl::Context first = renderer.gpu().context;
    renderer.change(pbr);
    EXPECT_EQ(renderer.gpu().context(), first());
    layer.arm(3, CL_OUT_OF_RESOURCES);
    Frame frame;
    EXPECT_NE(error_of_frame(renderer, camera, frame), "");
    layer.arm(0, 0);
    renderer.change(lambert);
    EXPECT_NE(renderer.gpu().context(), first());
    EXPECT_EQ(error_of_frame(renderer, camera, frame), "");
    EXPECT_EQ(frame.radiance, right.radiance);
}

TEST(OpenClFaults, EveryCallOfTheStartMayFail) {
    start_opencl();
    const FaultLayer layer;
    ASSERT_TRUE(layer.loaded());
    const Scene scene = make_generated_scene("plain");
    int calls = 0;
    for (int run = 0; run < 2; ++run) {  // a process' first renderer may make more calls
        layer.arm(0, 0);
        Renderer renderer(scene, faulty_settings());
        renderer.render(first_camera(scene), 0.0);
        calls = layer.calls();  // of the picture: errors of later calls, at destruction, are not
                                // reported
    }
    std::mt19937 random(7);
    // The first ones make context and queue; the others are a sample.
    std::vector<int> chosen = {1, 2, 3, 4, 5, 6, 7, 8};
    for (int i = 0; i < 24; ++i)
        chosen.push_back(9 + static_cast<int>(random() % static_cast<unsigned>(calls - 8)));
    for (const int call : chosen) {
        SCOPED_TRACE("call " + std::to_string(call) + " of " + std::to_string(calls));
        layer.arm(call, CL_OUT_OF_RESOURCES);
        try {
            Renderer(scene, faulty_settings()).render(first_camera(scene), 0.0);
            FAIL() << "no error";
        } catch (const Error& error) {
            // A code without a name of ours appears as a number.
            const std::string message = error.what();
            EXPECT_TRUE(message.find("CL_OUT_OF_RESOURCES") != std::string::npos) << message;
        }
    }
}

}  // namespace
}  // namespace kilolux
