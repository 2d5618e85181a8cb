// SPDX-License-Identifier: Apache-2.0
// Lights what another renderer drew: light_exr GBUFFER.exr LIGHTS.csv LIT.exr DEGREES
//
// The EXR has depth along the view direction [m], world normals and linear albedo, in channels
// named as Blender's or ours; DEGREES is the camera's vertical angle. The attribute worldToCamera
// says where it stands; without it, at the origin, looking down -Z. A line of the CSV is a point
// light: x,y,z,range [m],red,green,blue [cd]; lines that begin with # are comments.
#include <OpenImageIO/imagebuf.h>
#include <kilolux/kilolux.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

using namespace kilolux;
using Channels = std::array<int, 3>;

// The channel "<name><part>" of any layer; "/." begins every name.
int channel_of(const OIIO::ImageBuf& image, const std::vector<std::string>& names, char part) {
    for (int c = 0; c < image.nchannels(); ++c) {
        const std::string channel = "/." + std::string(image.spec().channel_name(c));
        for (const std::string& name : names) {
            if (channel.ends_with(name + part)) return c;
        }
    }
    throw Error(std::string(image.name()) + ": has no channel " + names[0].substr(1) + part);
}

Channels channels_of(const OIIO::ImageBuf& image, const std::vector<std::string>& names,
                     const char* parts) {
    return {channel_of(image, names, parts[0]), channel_of(image, names, parts[1]),
            channel_of(image, names, parts[2])};
}

MatrixView camera_of(const OIIO::ImageSpec& spec, double degrees) {
    if (!(degrees > 0 && degrees < 180)) throw Error("DEGREES must be between 0 and 180");
    const double y = 1.0 / std::tan(degrees * 3.14159265358979 / 360.0);
    ViewMatrices matrices{
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
        {y * spec.height / spec.width, 0, 0, 0, 0, y, 0, 0, 0, 0, 0, -1, 0, 0, 0.1, 0},
        static_cast<uint>(spec.width),
        static_cast<uint>(spec.height)};
    float world[16];
    if (spec.getattribute("worldToCamera", OIIO::TypeMatrix, world))
        std::copy_n(world, 16, matrices.view.begin());
    return make_view(matrices);
}

std::vector<Light> read_lights(const char* file, const std::array<double, 3>& camera) {
    std::ifstream in(file);
    if (!in) throw Error(std::string(file) + ": cannot be read");
    std::vector<Light> lights;
    int number = 0;
    for (std::string line; std::getline(in, line) && ++number > 0;) {
        if (line.empty() || line[0] == '#') continue;
        double p[3];
        float range = 0, r = 0, g = 0, b = 0;
        char more = 0;
        const int read = std::sscanf(line.c_str(), "%lf,%lf,%lf,%f,%f,%f,%f %c", &p[0], &p[1],
                                     &p[2], &range, &r, &g, &b, &more);
        if (read != 7 || !(range > 0)) {
            throw Error(std::string(file) + ": line " + std::to_string(number) + ": '" + line +
                        "' is not x,y,z,range > 0,red,green,blue");
        }
        const auto relative = [&](std::size_t i) { return static_cast<float>(p[i] - camera[i]); };
        lights.push_back(
            {{relative(0), relative(1), relative(2), range}, {r, g, b, 1}, {0, 0, 0, -1}});
    }
    return lights;
}

// The float32 layout: position and normal in view space, albedo, roughness.
std::vector<std::byte> planes_of(const OIIO::ImageBuf& image, const View& v,
                                 const GBufferLayout& layout) {
    std::vector<std::byte> bytes(gbuffer_bytes(layout, v.stride, v.height));
    const int depth = channel_of(image, {".Depth.", "/."}, 'Z');
    const Channels normal = channels_of(image, {".Normal.", ".N."}, "XYZ");
    const Channels albedo = channels_of(image, {".albedo.", " Albedo.", ".DiffCol."}, "RGB");
    for (uint from = 0; from < v.width * v.height; ++from) {
        const uint x = from % v.width, y = from / v.width;
        const auto at = [&](int c) {
            return image.getchannel(static_cast<int>(x), static_cast<int>(y), 0, c);
        };
        const auto at3 = [&](const Channels& c) { return fv3(at(c[0]), at(c[1]), at(c[2])); };
        const float z = at(depth);
        if (!(z > 0.0f && z < 1e9f)) continue;  // background: Blender writes 1e10
        const auto put = [&](uint plane, float value) {
            float* const values = reinterpret_cast<float*>(&bytes[layout.offset_bytes[plane]]);
            values[std::size_t{y} * v.stride + x] = value;
        };
        const auto put3 = [&](uint plane, const FV3& value) {
            put(plane, value.x), put(plane + 1, value.y), put(plane + 2, value.z);
        };
        const FV3 n = at3(normal);
        const auto along = [&n](const float4& r) { return r.x * n.x + r.y * n.y + r.z * n.z; };
        put(KILOLUX_PLANE_DEPTH, ((v.orthographic != 0 ? z : 1.0f / z) - v.depth.w) / v.depth.x);
        put3(KILOLUX_PLANE_POSITION_X,
             view_position(v, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, z));
        put3(KILOLUX_PLANE_NORMAL_X, fv3(along(v.view_from_world_x), along(v.view_from_world_y),
                                         along(v.view_from_world_z)));
        put3(KILOLUX_PLANE_ALBEDO_R, at3(albedo));
        put(KILOLUX_PLANE_ROUGHNESS, 1.0f);
    }
    return bytes;
}

template <typename T>
cl::Buffer copy(const Gpu& gpu, std::vector<T>& v) {
    v.resize(std::max<std::size_t>(v.size(), 1));
    return {gpu.context, CL_MEM_COPY_HOST_PTR, v.size() * sizeof(T), v.data()};
}

int main(int argc, char** argv) try {
    if (argc != 5) throw Error("usage: light_exr GBUFFER.exr LIGHTS.csv LIT.exr DEGREES");
    OIIO::ImageBuf image(argv[1]);
    if (!image.read(0, 0, true, OIIO::TypeDesc::FLOAT)) throw Error(image.geterror());
    const MatrixView camera = camera_of(image.spec(), std::atof(argv[4]));
    const View& view = camera.view;
    std::vector<Light> lights = read_lights(argv[2], camera.camera);
    const auto count = static_cast<uint>(lights.size());
    const Gpu gpu(choose_device(""));
    KernelFeatures features;  // Lambert surfaces
    features.gbuffer = KILOLUX_GBUFFER_FULL;
    features.light_index_bits = 32;
    GBufferNeeds needs;
    needs.layout = features.gbuffer;
    const GBufferLayout layout = make_gbuffer_layout(needs, view.stride, view.height);
    std::vector<std::byte> planes = planes_of(image, view, layout);
    const GBuffer gbuffer{copy(gpu, planes), layout, view};
    const LightInput input{copy(gpu, lights), count};
    DeferredLighting lighting(gpu, known_tuning(gpu.info).tuning, features);
    StageTimer timer;
    const ClusterGrid grid = make_cluster_grid({.position_pad = 1e-3f}, view.width, view.height);
    const std::vector<float> lit =
        download(gpu, lighting.light({gbuffer, input, grid}, timer).planes);
    OIIO::ImageBuf out({image.spec().width, image.spec().height, 3, OIIO::TypeDesc::FLOAT});
    for (uint i = 0; i < view.width * view.height; ++i) {
        const uint x = i % view.width, y = i / view.width;
        const std::size_t at = std::size_t{y} * view.stride + x, plane = lit.size() / 3;
        const float rgb[] = {lit[at], lit[plane + at], lit[2 * plane + at]};
        out.setpixel(static_cast<int>(x), static_cast<int>(y), rgb);
    }
    if (!out.write(argv[3])) throw Error(out.geterror());
    std::printf("%u lights, %ux%u pixels\n", count, view.width, view.height);
} catch (const std::exception& error) {
    std::fprintf(stderr, "light_exr: %s\n", error.what());
    return 1;
}
