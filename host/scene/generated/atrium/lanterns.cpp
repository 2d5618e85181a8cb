// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/lanterns.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "host/scene/generated/atrium/atrium.h"
#include "host/scene/generated/atrium/materials.h"
#include "host/scene/generated/atrium/plan.h"
#include "host/scene/generated/mesh_builder.h"
#include "host/scene/generated/small.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

using namespace atrium_plan;

constexpr glm::vec3 kWarm(1.0f, 0.62f, 0.30f);  // linear Rec. 709
constexpr glm::vec3 kAmber(1.0f, 0.46f, 0.15f);
constexpr glm::vec3 kCool(0.30f, 0.55f, 1.0f);

// A kind of lamp: its light and how its mesh looks. A glowing mesh is far dimmer than its light, so
// that it keeps its hue in the picture.
struct Lamp {
    const char* name;
    LightType type;
    glm::vec3 color;  // largest component 1
    float candela;    // of that component, straight ahead
    float range;      // [m]
    float width;      // [m]; of a sphere its diameter
    float height;     // [m]
    float glow;       // emission of the mesh's largest component
    bool has_mesh;    // else the atrium has one
};

constexpr Lamp kCage{"cage", LightType::sphere, kWarm, 11.0f, 7.0f, 0.54f, 0.0f, 3.0f, false};
constexpr Lamp kGlobe{"globe", LightType::sphere, kWarm, 7.0f, 6.0f, 0.40f, 0.0f, 4.0f, true};
constexpr Lamp kArchGlobe{"arch-globe", LightType::sphere, kAmber, 5.5f, 5.0f, 0.26f, 0.0f, 4.0f,
                          true};
constexpr Lamp kBulb{"bulb", LightType::sphere, kWarm, 1.3f, 7.0f, 0.10f, 0.0f, 6.0f, true};
constexpr Lamp kSmallGlobe{"small-globe", LightType::sphere, kAmber, 1.0f, 3.0f, 0.18f, 0.0f, 4.0f,
                           true};
constexpr Lamp kCandle{"candle", LightType::sphere, kAmber, 0.5f, 2.0f, 0.05f, 0.0f, 6.0f, true};
constexpr Lamp kPanel{"panel", LightType::rectangle, kCool, 26.0f, 5.5f, 1.7f, 0.30f, 3.0f, true};
constexpr Lamp kNicheDisk{"niche-disk", LightType::disk, kWarm, 4.0f, 3.5f,
                          0.22f,        0.22f,           3.0f,  true};
constexpr Lamp kMoon{
    "moon", LightType::sphere, {0.50f, 0.68f, 1.0f}, 700.0f, 60.0f, 2.4f, 0.0f, 0.0f, false};

// The share of a light's radius that its mesh has, so that its shadow rays end before the mesh.
constexpr double kMeshShare = 0.96;

int add_glow(Scene& scene, const Lamp& lamp) {
    const int material = add_diffuse(scene, lamp.name, lamp.color);
    scene.materials.back().emissive = lamp.glow * lamp.color;
    return material;
}

MeshBuilder mesh_of(const Lamp& lamp) {
    if (lamp.type == LightType::sphere) {
        return ball(0.5 * kMeshShare * lamp.width, lamp.width > 0.15f ? 24 : 12);
    }
    // A plate above the light that shines down from the origin.
    constexpr double kGap = 2e-3, kThickness = 0.04;
    MeshBuilder plate;
    const double x = 0.5 * lamp.width, z = 0.5 * lamp.height;
    if (lamp.type == LightType::rectangle) {
        plate.box({-x, kGap, -z}, {x, kGap + kThickness, z});
    } else {
        plate.lathe({{Point2(0.0, kGap), Point2(x, kGap), Point2(x, kGap + kThickness)}, 0.6}, 24);
    }
    return plate;
}

// Hangs lamps of one kind.
class Lamps {
 public:
    Lamps(Scene& scene, const Lamp& lamp, std::uint64_t seed)
        : scene_(scene),
          lamp_(lamp),
          seed_(seed),
          node_(static_cast<int>(scene.light_nodes.size())) {
        scene.light_nodes.push_back({lamp.name, ""});
        if (!lamp.has_mesh) return;
        const int material = add_glow(scene, lamp);
        mesh_ = add_mesh(scene, mesh_of(lamp).build(lamp.name, material, 1.0, false));
    }

    void hang(const glm::dmat4& frame, const glm::dvec3& at) {
        const glm::dmat4 world = frame * placed(at);
        if (lamp_.has_mesh) place(scene_, mesh_, world);
        SceneLight& light = scene_.lights.emplace_back();
        light.type = lamp_.type;
        light.node = node_;
        light.position = glm::dvec3(world[3]);
        light.direction = {0, -1, 0};
        light.side = glm::dvec3(world[0]);
        light.intensity = lamp_.candela * lamp_.color * flicker();
        light.range = lamp_.range;
        light.width = lamp_.width;
        light.height = lamp_.height;
        light.radius = 0.5f * lamp_.width;
    }

 private:
    // Red, green and blue of a lamp that is a little brighter or redder than others.
    glm::vec3 flicker() {
        const std::uint64_t key = item_key(seed_, scene_.lights.size());
        const auto random = [key](std::uint64_t s) {
            return static_cast<float>(unit_double(item_bits(key, s)) - 0.5);
        };
        const float bright = 1.0f + 0.3f * random(0), red = 0.2f * random(1);
        return bright * glm::vec3(1.0f, 1.0f - red, 1.0f - 2.0f * red);
    }

    Scene& scene_;
    Lamp lamp_;
    std::uint64_t seed_;
    int node_;
    int mesh_ = -1;
};

void hang_in_hall(Scene& scene, std::uint64_t seed) {
    Lamps cages(scene, kCage, seed), globes(scene, kGlobe, seed), arches(scene, kArchGlobe, seed);
    Lamps niches(scene, kNicheDisk, seed);
    scene.materials[static_cast<std::size_t>(AtriumMaterial::glass)].emissive =
        kCage.glow * kCage.color;
    MeshBuilder long_cord, short_cord;
    const glm::dvec3 long_ends[2] = {{0, 0, 0}, {0, -1.75, 0}},
                     short_ends[2] = {{0, 0, 0}, {0, -0.5, 0}};
    long_cord.tube(long_ends, 0.008, 5);
    short_cord.tube(short_ends, 0.008, 5);
    const int long_mesh = add_atrium_mesh(scene, "long-cord", long_cord, AtriumMaterial::iron);
    const int short_mesh = add_atrium_mesh(scene, "short-cord", short_cord, AtriumMaterial::iron);
    for (const Place& bay : bays()) {
        const glm::dmat4& at = bay.world_from_piece;
        const glm::dvec3 crown(0.0, kSpring + kVaultRise, 0.5 * kAisle);
        if (is_even(bay)) {
            cages.hang(at, crown - glm::dvec3(0.0, 2.1, 0.0));
        } else {
            globes.hang(at, crown - glm::dvec3(0.0, 1.95, 0.0));
            place(scene, long_mesh, at * placed(crown));
        }
        const glm::dvec3 keystone(0.0, kSpring + kArchRadius, 0.0);
        arches.hang(at, keystone - glm::dvec3(0.0, 0.62, 0.0));
        place(scene, short_mesh, at * placed(keystone));
        niches.hang(at, {0.0, 2.86, kAisle + 0.16});
    }
}

void hang_in_gallery(Scene& scene, std::uint64_t seed) {
    Lamps globes(scene, kSmallGlobe, seed), panels(scene, kPanel, seed);
    for (const Place& bay : bays()) {
        const glm::dmat4& at = bay.world_from_piece;
        for (const double side : {-0.5, 0.5}) {
            globes.hang(at, {side * kHalfBay, kUpperSpring + 0.3, 0.0});
        }
        panels.hang(at, {0.0, kCeiling - 0.12, 0.5 * kAisle + 0.1});
    }
    for (const Place& corner : corners()) {
        panels.hang(corner.world_from_piece, {0.5 * kAisle, kCeiling - 0.12, 0.5 * kAisle});
    }
}

// Strings of bulbs across the court, from column to column.
void hang_strings(Scene& scene, std::uint64_t seed) {
    constexpr int kBulbs = 13;
    constexpr double kHalf = kHalfZ - kWallHalf - 0.1, kHeight = 5.55, kSag = 1.15;
    const auto at = [](double t) {  // 0 to 1 along the string
        const double u = 2.0 * t - 1.0;
        return glm::dvec3(0.0, kHeight - kSag * (1.0 - u * u), kHalf * u);
    };
    MeshBuilder wire;
    std::vector<glm::dvec3> path;
    for (int i = 0; i <= 26; ++i) path.push_back(at(i / 26.0));
    wire.tube(path, 0.008, 5);
    const int wire_mesh =
        add_atrium_mesh(scene, "string", wire.moved({0.0, 0.06, 0.0}), AtriumMaterial::iron);
    Lamps bulbs(scene, kBulb, seed);
    for (int i = 1; i < kLongBays; ++i) {
        const glm::dmat4 string = placed({i * kBay - kHalfX, 0.0, 0.0});
        place(scene, wire_mesh, string);
        for (int k = 0; k < kBulbs; ++k) bulbs.hang(string, at((k + 0.5) / kBulbs));
    }
}

// Candles on the steps, and floating on the water.
void light_candles(Scene& scene, std::uint64_t seed) {
    constexpr double kStem = 0.10, kFlame = 0.13;  // [m]
    MeshBuilder stem;
    stem.lathe({{Point2(0.045, 0.0), Point2(0.045, kStem - 0.01), Point2(0.035, kStem),
                 Point2(0.0, kStem - 0.005)},
                0.6},
               12);
    const int stem_mesh = add_atrium_mesh(scene, "candle-stem", stem, AtriumMaterial::limestone);
    Lamps flames(scene, kCandle, seed);
    const auto stand = [&](const glm::dmat4& frame, const glm::dvec3& at) {
        place(scene, stem_mesh, frame * placed(at));
        flames.hang(frame, at + glm::dvec3(0.0, kFlame, 0.0));
    };
    for (const Place& bay : bays()) {
        for (const double side : {-0.8, 0.8}) {
            stand(bay.world_from_piece, {side, kCourtFloor + 0.30, -(kStepsDepth - 0.52)});
        }
    }
    constexpr int kFloating = 20;
    for (int i = 0; i < kFloating; ++i) {
        const std::uint64_t key = item_key(seed, static_cast<std::uint64_t>(i));
        const double turn =
            2.0 * std::numbers::pi * (i + 0.6 * unit_double(item_bits(key, 4))) / kFloating;
        const double out = 0.62 + 0.3 * unit_double(item_bits(key, 5));
        stand(glm::dmat4(1.0),
              {2.85 * out * std::cos(turn), kCourtFloor + 0.33, 1.1 * out * std::sin(turn)});
    }
}

}  // namespace

Scene make_lanterns(std::uint64_t seed) {
    Scene scene = make_atrium(seed);
    scene.name = "lanterns";
    hang_in_hall(scene, seed);
    hang_in_gallery(scene, seed);
    hang_strings(scene, seed);
    light_candles(scene, seed);
    Lamps(scene, kMoon, seed).hang(placed({13.0, 24.0, -9.0}), glm::dvec3(0.0));
    return scene;
}

}  // namespace kilolux
