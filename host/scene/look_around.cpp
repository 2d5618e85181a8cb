// SPDX-License-Identifier: Apache-2.0
#include "host/scene/look_around.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr double kApart = 1e-6f;    // of the box's diagonal: surfaces on a line
constexpr double kFarthest = 1e7;   // coordinate of a ray, in units of the scene
constexpr double kMostEntry = 1e9;  // of an instance's matrix and its inverse: Embree ends
                                    // the program where a ray becomes 1.8e18 long
constexpr int kCells = 16;          // of a cube's face, along an edge: see level()

// The axes of a cube's level faces: across, through.
struct Face {
    glm::dvec3 right, out;
};
constexpr Face kLevelFaces[4] = {{{0, 0, -1}, {1, 0, 0}},
                                 {{0, 0, 1}, {-1, 0, 0}},
                                 {{1, 0, 0}, {0, 0, 1}},
                                 {{-1, 0, 0}, {0, 0, -1}}};

struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceOwner = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceDeleter>;
using SceneOwner = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneDeleter>;

SceneOwner new_scene(RTCDevice device) {
    SceneOwner scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
    return scene;
}

void attach(RTCScene scene, RTCGeometry geometry, std::size_t number) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(number));
    rtcReleaseGeometry(geometry);
}

// A power of two, so that products with it are exact, that takes the value into [1, 2); 1 for 0.
double unit_scale(double value) { return value > 0.0 ? std::ldexp(1.0, -std::ilogb(value)) : 1.0; }

// Of the triangles' corners: positions that no triangle uses may lie anywhere.
double largest_coordinate(const Mesh& mesh) {
    double largest = 0.0;
    for (const std::uint32_t corner : mesh.indices) {
        const glm::vec3& p = mesh.positions[corner];
        for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(double{p[i]}));
    }
    return largest;
}

// Of the mesh's positions times `scale`.
SceneOwner mesh_scene(RTCDevice device, const Mesh& mesh, double scale) {
    SceneOwner scene = new_scene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree's own copy: it may read 16 bytes at the last vertex.
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(glm::vec3), mesh.positions.size());
    if (vertices == nullptr) throw Error("looking around the scene: out of memory");
    std::transform(mesh.positions.begin(), mesh.positions.end(), static_cast<glm::vec3*>(vertices),
                   [&](const glm::vec3& p) { return glm::vec3(glm::dvec3(p) * scale); });
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.indices.data(), 0, 3 * sizeof(std::uint32_t),
                               mesh.indices.size() / 3);
    attach(scene.get(), geometry, 0);
    rtcCommitScene(scene.get());
    return scene;
}

// Whether a ray stays in Embree's range where it meets an instance.
bool keeps_rays_in_range(const glm::mat4& moved) {
    const glm::dmat4 inverse = glm::inverse(glm::dmat4(moved));
    for (int i = 0; i < 16; ++i) {
        for (const double value : {inverse[i / 4][i % 4], double{moved[i / 4][i % 4]}}) {
            if (!(std::abs(value) < kMostEntry)) return false;
        }
    }
    return true;
}

// Whether a mesh has a size where `moved` puts it: Embree asserts it of what it divides.
bool has_size(RTCScene mesh, const glm::mat4& moved) {
    RTCBounds b;
    rtcGetSceneBounds(mesh, &b);
    glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
    for (int i = 0; i < 8; ++i) {
        const glm::vec4 corner((i & 1) != 0 ? b.upper_x : b.lower_x,
                               (i & 2) != 0 ? b.upper_y : b.lower_y,
                               (i & 4) != 0 ? b.upper_z : b.lower_z, 1.0f);
        const glm::vec3 p(moved * corner);
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    constexpr float kRounding = 1e-6f;  // of Embree's own product, sixteen times
    const glm::vec3 size = high - low, place = glm::max(glm::abs(low), glm::abs(high));
    return std::max({size.x, size.y, size.z}) > kRounding * std::max({place.x, place.y, place.z});
}

}  // namespace

// Embree's scene of the instances. Its numbers are floats, and it ends the program where they leave
// its range: places are relative to the middle of the scene's box in units of about its diagonal,
// and a mesh is in units of about its own extent.
struct LookAround::Rays {
    struct ScaledMesh {
        double scale = 0.0;  // of its positions; 0: not built yet
        SceneOwner scene{};
    };

    const Scene& scene;
    glm::dvec3 middle;
    double scale;  // of the scene's places
    double apart;  // surfaces on a line, in those units
    DeviceOwner device{rtcNewDevice(nullptr)};
    std::vector<ScaledMesh> meshes{};
    SceneOwner instances{};

    void add(std::size_t number, const Instance& instance) {
        const auto shape = static_cast<std::size_t>(instance.mesh);
        const Mesh& mesh = scene.meshes[shape];
        if (mesh.indices.empty() || is_blended(scene, mesh)) return;
        ScaledMesh& scaled = meshes[shape];
        if (scaled.scale == 0.0) {
            const double largest = largest_coordinate(mesh);
            if (largest == 0.0) return;  // all corners are the origin
            scaled.scale = unit_scale(largest);
            scaled.scene = mesh_scene(device.get(), mesh, scaled.scale);
        }
        glm::dmat4 placed = instance.world_from_object;
        placed[3] -= glm::dvec4(middle, 0.0);
        for (int i = 0; i < 4; ++i) {
            const double of_column = i < 3 ? scale / scaled.scale : scale;
            placed[i] = glm::dvec4(of_column * glm::dvec3(placed[i]), placed[i].w);
        }
        const glm::mat4 moved(placed);
        if (!keeps_rays_in_range(moved) || !has_size(scaled.scene.get(), moved)) return;
        RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, scaled.scene.get());
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &moved);
        attach(instances.get(), geometry, number);
    }

    // Where a line meets the plane of a triangle, in double.
    Hit hit(const Instance& instance, std::size_t triangle, const glm::dvec3& eye,
            const glm::dvec3& ray) const {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const auto corner = [&](std::size_t i) {
            const glm::dvec4 p(mesh.positions[mesh.indices[3 * triangle + i]], 1.0);
            return glm::dvec3(instance.world_from_object * p) - eye;
        };
        const glm::dvec3 first = corner(0);
        const glm::dvec3 normal = glm::cross(corner(1) - first, corner(2) - first);
        const double along = glm::dot(normal, ray);
        const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0.0;
        const double distance = glm::dot(normal, first) / along * glm::length(ray);
        return {static_cast<float>(distance), (along < 0.0) != mirrored ? Side::front : Side::back,
                (mirrored ? -1.0 : 1.0) * glm::normalize(normal)};
    }
};

LookAround::LookAround(const Scene& scene, const Box& box)
    : rays_(new Rays{scene, box.center(), unit_scale(glm::length(box.size())), 0.0}) {
    rays_->apart = kApart * rays_->scale * glm::length(box.size());
    RTCDevice device = rays_->device.get();
    if (device == nullptr) throw Error("looking around the scene: Embree has no device");
    rays_->meshes.resize(scene.meshes.size());
    rays_->instances = new_scene(device);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) rays_->add(i, scene.instances[i]);
    rtcCommitScene(rays_->instances.get());
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        throw Error(fmt::format("looking around the scene: Embree's error {} ({})",
                                static_cast<int>(error),
                                error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "building"));
    }
}

LookAround::~LookAround() = default;

LookAround::Hit LookAround::first_hit(const glm::dvec3& eye, const glm::dvec3& direction,
                                      float beyond) const {
    const glm::dvec3 start = rays_->scale * (eye - rays_->middle);
    const double nearest = rays_->scale * double{beyond} + rays_->apart;
    for (const double value :
         {start.x, start.y, start.z, direction.x, direction.y, direction.z, nearest}) {
        if (!(std::abs(value) < kFarthest)) return {};
    }
    const glm::vec3 from(start), along(direction);
    RTCRayHit query{};
    query.ray.org_x = from.x;
    query.ray.org_y = from.y;
    query.ray.org_z = from.z;
    query.ray.dir_x = along.x;
    query.ray.dir_y = along.y;
    query.ray.dir_z = along.z;
    query.ray.tnear = static_cast<float>(nearest);
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(rays_->instances.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return rays_->hit(rays_->scene.instances[query.hit.instID[0]], query.hit.primID, eye,
                      direction);
}

std::vector<LookAround::Level> LookAround::level(const glm::dvec3& eye) const {
    std::vector<Level> out;
    for (const Face& face : kLevelFaces) {
        for (int i = 0; i < kCells; ++i) {
            const glm::dvec3 ray = face.out + ((2.0 * i + 1.0) / kCells - 1.0) * face.right;
            const glm::dvec3 up(0.0, 1.0 / kCells, 0.0);
            out.push_back({glm::normalize(ray), std::min(first_hit(eye, ray - up).distance,
                                                         first_hit(eye, ray + up).distance)});
        }
    }
    return out;
}

double LookAround::below(const glm::dvec3& eye) const {
    constexpr double kBeside = 1.0 / kCells;
    float least = Hit{}.distance;
    for (const double x : {-kBeside, kBeside}) {
        for (const double z : {-kBeside, kBeside}) {
            least = std::min(least, first_hit(eye, {x, -1.0, z}).distance);
        }
    }
    return least;
}

double way_out(const Box& box, const glm::dvec3& from, const glm::dvec3& direction) {
    double way = glm::length(box.size());
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) continue;
        const double side = direction[axis] > 0.0 ? box.max[axis] : box.min[axis];
        way = std::min(way, (side - from[axis]) / direction[axis]);
    }
    return std::max(way, 0.0);
}

}  // namespace kilolux
