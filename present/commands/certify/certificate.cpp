// SPDX-License-Identifier: Apache-2.0
#include "present/commands/certify/certificate.h"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "host/base/error.h"
#include "host/base/system/child_process.h"
#include "host/base/system/interrupt.h"
#include "host/base/system/temporary_folder.h"
#include "host/base/text.h"
#include "host/certify/lighting_case.h"
#include "host/measure/bench/run.h"
#include "host/render/renderer.h"
#include "present/cli/names.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench_context.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Step = std::function<void()>;

// A picture of a generated scene on a device. OpenCL draws its triangles: no OpenGL is needed.
struct GeneratedPicture {
    const char* scene;
    int width, height;  // [pixel]
    std::uint64_t lights;
    Shading shading = Shading::automatic;
    Shadows shadows = Shadows::off;
};

SharedOptions options_of(const GeneratedPicture& picture, const cl::Device& device) {
    SharedOptions options;
    options.scene = picture.scene;
    RenderSettings& s = options.settings;
    s.width = picture.width;
    s.height = picture.height;
    s.lights.count = picture.lights;
    s.shading = picture.shading;
    s.shadows = picture.shadows;
    s.geometry = Geometry::compute;
    const std::vector<cl::Device> devices = all_devices();
    s.device = fmt::to_string(std::ranges::find(devices, device) - devices.begin());
    measure_swarm(options);
    return options;
}

Json equality(const cl::Device& device, const Step& step) {
    constexpr GeneratedPicture kPictures[] = {
        {"atrium", 320, 180, 500, Shading::lambert},
        {"atrium", 320, 180, 500, Shading::blinn_phong},
        {"atrium", 320, 180, 500, Shading::pbr},
        {"corridor", 320, 180, 200, Shading::pbr, Shadows::exact}};
    Json out = {{"passed", true}, {"pictures", Json::array()}};
    for (const GeneratedPicture& picture : kPictures) {
        SharedOptions options = options_of(picture, device);
        const Scene scene = open_scene(options);
        const Camera camera = choose_camera(options, scene);
        const auto radiance = [&](RendererKind renderer) {
            options.settings.renderer = renderer;
            step();
            return Renderer(scene, options.settings).render(camera, options.time).radiance;
        };
        const std::vector<float> listed = radiance(RendererKind::deferred);
        const std::vector<float> all = radiance(RendererKind::deferred_all);
        const auto different = static_cast<std::uint64_t>(different_bits(listed, all).value);
        const auto lit = std::ranges::count_if(all, [](float value) { return value > 0.0f; });
        if (different > 0 || lit == 0) out["passed"] = false;
        out["pictures"].push_back({{"scene", picture.scene},
                                   {"resolution", {picture.width, picture.height}},
                                   {"lights", picture.lights},
                                   {"shading", name_of(picture.shading)},
                                   {"shadows", name_of(picture.shadows)},
                                   {"values", all.size()},
                                   {"lit", lit},
                                   {"different", different}});
    }
    return out;
}

std::vector<std::string> lines_of(const std::string& file) {
    std::vector<std::string> lines;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (!trim(line).empty()) lines.push_back(line);
    }
    return lines;
}

// What tests/opencl/oclgrind.cmake says of oclgrind's options holds here, too.
Json oclgrind(const cl::Device& device, const Step& step) {
    const char* why = describe(device).is_oclgrind() ? "this device is oclgrind"
                      : !has_program("oclgrind")     ? "not installed"
                                                     : nullptr;
    if (why != nullptr) return {{"passed", true}, {"ran", false}, {"why", why}};
    const TemporaryFolder scratch;
    const std::string log = scratch / "log", picture = scratch / "picture.exr";
    const std::vector<std::string> frame = {"render",       "plain", "--geometry", "compute",
                                            "--resolution", "48,32", "--lights",   "8",
                                            "--shading",    "pbr",   "--bloom",    "0.1"};
    std::vector<std::string> words = {"oclgrind",     "--build-options", "-cl-opt-disable",
                                      "--data-races", "--check-api",     "--max-errors",
                                      "20",           "--log",           log};
    words.push_back(fs::read_symlink("/proc/self/exe").string());
    words.insert(words.end(), frame.begin(), frame.end());
    words.insert(words.end(), {"--quiet", "-o", picture});
    ChildProcess child(words);
    const bool succeeded = child.succeeded();
    step();
    const std::vector<std::string> reports = lines_of(log);
    Json out = {{"passed", succeeded && fs::exists(picture) && reports.empty()},
                {"ran", true},
                {"frame", joined(frame, " ")},
                {"checks", {"memory", "data races", "API"}},
                {"report_lines", reports.size()}};
    if (!reports.empty()) out["first_report"] = reports.front();
    if (!succeeded) out["error"] = joined(child.messages(), "; ");
    return out;
}

Json stages(const cl::Device& device, const Step& step) {
    constexpr GeneratedPicture kFrame = {"atrium", 960, 540, 1000};
    constexpr BenchFrames kFrames = {.warm_up = 5, .measured = 20};
    SharedOptions options = options_of(kFrame, device);
    const Scene scene = open_scene(options);
    const RenderSettings& settings = options.settings;
    BenchRun run(scene, settings, choose_camera(options, scene), options.time);
    run.on_frame(step);
    SweepPoint point;
    point.resolution = {kFrame.width, kFrame.height};
    point.lights = kFrame.lights;
    const std::vector<BenchRow> rows = run.measure(point, kFrames);
    const std::uint64_t different = rows.front().error.different_pixels;
    Json out = {{"passed", different == 0},       {"scene", kFrame.scene},
                {"resolution", point.resolution}, {"lights", point.lights},
                {"frames", kFrames.measured},     {"different_pixels", different},
                {"rows", Json::array()}};
    for (const BenchRow& row : rows) {
        out["rows"].push_back({{"stage", row.stage},
                               {"median_ms", row.ms.median},
                               {"limit_ms", row.limit_ms > 0.0 ? Json(row.limit_ms) : Json()},
                               {"bound", row.bound}});
    }
    out["limits"] = limits_json(run.limits());
    return out;
}

Json tuning(const cl::Device& device, const Step&) {
    const KnownTuning known = known_tuning(describe(device));
    return {{"passed", true}, {"source", text_of(known.source)}, {"values", tuning_json(known)}};
}

std::string processor_name() {
    for (const std::string& line : lines_of("/proc/cpuinfo")) {
        const auto parts = split(line, ':');
        if (parts.size() == 2 && trim(parts[0]) == "model name") return std::string(trim(parts[1]));
    }
    return "unknown";
}

// The vector instructions of the host's processor, widest last.
Json vector_instructions() {
    Json out = Json::array();
    for (const std::string& line : lines_of("/proc/cpuinfo")) {
        if (!line.starts_with("flags")) continue;
        const auto flags = split(line, ' ');
        for (const char* name : {"sse2", "avx", "fma", "avx2", "avx512f"}) {
            if (std::ranges::find(flags, name) != flags.end()) out.push_back(name);
        }
        break;
    }
    return out;
}

// Variables by which drivers choose devices, code and checks.
Json driver_environment() {
    constexpr const char* kPrefixes[] = {
        "POCL_DEVICES", "POCL_KERNELLIB", "POCL_LLVM",      "POCL_MAX_WORK", "POCL_WORK_GROUP",
        "RUSTICL_",     "GALLIUM_",       "OCLGRIND_BUILD", "LP_",           "CUDA_FORCE_"};
    std::set<std::string> found;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string text = *entry;
        for (const char* prefix : kPrefixes) {
            if (text.starts_with(prefix)) found.insert(text);
        }
    }
    return found;
}

}  // namespace

Json capabilities_json(const cl::Device& device) {
    Json out = device_json(describe(device));
    const auto fp = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
    const std::string extensions = device.getInfo<CL_DEVICE_EXTENSIONS>();
    const auto has = [&](const char* name) { return extensions.find(name) != std::string::npos; };
    out["vendor"] = device.getInfo<CL_DEVICE_VENDOR>().c_str();
    out["opencl_c"] = device.getInfo<CL_DEVICE_OPENCL_C_VERSION>().c_str();
    out["native_float_lanes"] = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    out["clock_mhz"] = device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>();
    out["local_memory_bytes"] = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    out["largest_group"] = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    out["denormals"] = (fp & CL_FP_DENORM) != 0;
    out["hardware_fma"] = (fp & CL_FP_FMA) != 0;
    out["rounds_division_and_roots"] = (fp & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    out["float64"] = has("cl_khr_fp64");
    out["gl_sharing"] = has("cl_khr_gl_sharing");
    out["host_processor"] = processor_name();
    out["host_instructions"] = vector_instructions();
    out["environment"] = driver_environment();
    return out;
}

const std::vector<CertificatePart>& certificate_parts() {
    static const std::vector<CertificatePart> kParts = {
        {"equality", equality}, {"oclgrind", oclgrind}, {"stages", stages}, {"tuning", tuning}};
    return kParts;
}

Json made_part(const CertificatePart& part, const cl::Device& device, const Step& step) {
    try {
        return part.make(device, step);
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        // The OpenCL compiler also fails after a signal.
        check_interrupt();
        return {{"passed", false}, {"error", error.what()}};
    }
}

}  // namespace kilolux
