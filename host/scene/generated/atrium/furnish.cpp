// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/atrium.h"

#include <array>

#include "host/scene/generated/atrium/materials.h"
#include "host/scene/generated/atrium/pieces.h"
#include "host/scene/generated/atrium/plan.h"
#include "host/scene/lights/light_generator_hash.h"

namespace kilolux {
namespace {

using namespace atrium_plan;

constexpr double kPotHeight = 0.56;  // [m] of the soil

bool even(const Place& bay) { return (bay.index + bay.side) % 2 == 0; }

void add_niche_things(Scene& scene) {
    const int urn_mesh = add_atrium_mesh(scene, "urn", urn(), AtriumMaterial::terracotta);
    const int bench_mesh = add_atrium_mesh(scene, "bench", bench(), AtriumMaterial::marble);
    for (const Place& bay : bays()) {
        const glm::dvec3 at =
            even(bay) ? glm::dvec3(0.0, 0.46, kAisle + 0.10) : glm::dvec3(0.0, 0.0, kAisle - 0.42);
        place(scene, even(bay) ? urn_mesh : bench_mesh, bay.world_from_piece * placed(at));
    }
}

void add_lanterns(Scene& scene) {
    constexpr double kChain = 1.9;
    const int iron = add_atrium_mesh(scene, "lantern", lantern_iron(kChain), AtriumMaterial::iron);
    const int glass =
        add_atrium_mesh(scene, "lantern-panes", lantern_glass(kChain), AtriumMaterial::glass);
    for (const Place& bay : bays()) {
        if (!even(bay)) continue;
        const glm::dmat4 crown =
            bay.world_from_piece * placed({0.0, kSpring + kVaultRise, kAisle / 2});
        place(scene, iron, crown);
        place(scene, glass, crown);
    }
}

void add_cloth(Scene& scene, std::uint64_t seed) {
    constexpr std::array kCloths = {AtriumMaterial::cloth_red, AtriumMaterial::cloth_blue,
                                    AtriumMaterial::cloth_gold};
    std::array<int, 3> banners{};
    for (std::size_t i = 0; i < kCloths.size(); ++i) {
        banners[i] = add_atrium_mesh(scene, "banner", banner(), kCloths[i]);
    }
    std::uint64_t colour = item_bits(seed, 3);
    const int drapes = add_atrium_mesh(scene, "curtain", curtain(), kCloths[seed % 2]);
    const int rod = add_atrium_mesh(scene, "curtain-rod", curtain_rod(), AtriumMaterial::iron);
    for (const Place& bay : bays()) {
        if (bay.side % 2 == 1) {
            place(scene, drapes, bay.world_from_piece);
            place(scene, rod, bay.world_from_piece);
        } else if (bay.index % 2 == 1) {
            place(scene, banners[colour++ % 3],
                  bay.world_from_piece * placed({0.0, kGalleryFloor - 0.01, -kWallHalf - 0.44}));
        }
    }
}

void add_plants(Scene& scene, std::uint64_t seed) {
    const int pots = add_atrium_mesh(scene, "pot", pot(), AtriumMaterial::terracotta);
    const int trunk =
        add_atrium_mesh(scene, "trunk", tree_trunk(kPotHeight - 0.02), AtriumMaterial::wood);
    const int crown = add_atrium_mesh(scene, "crown", foliage(2.15, 0.72, 460, item_bits(seed, 1)),
                                      AtriumMaterial::leaf);
    const int shrub = add_atrium_mesh(scene, "shrub", foliage(0.85, 0.42, 200, item_bits(seed, 2)),
                                      AtriumMaterial::leaf);
    for (int i = 0; i < 4; ++i) {
        const double x = i % 2 == 0 ? -1.0 : 1.0;
        const double z = i < 2 ? -1.0 : 1.0;
        // A quarter turn each, so that the four trees differ.
        const glm::dmat4 tree = placed({x * 4.4, kCourtFloor, z * 2.6}, i);
        for (const int mesh : {pots, trunk, crown}) place(scene, mesh, tree);
        const glm::dmat4 low = placed({x * 7.4, kCourtFloor, z * 2.75}, i + 1);
        for (const int mesh : {pots, shrub}) place(scene, mesh, low);
    }
}

}  // namespace

void furnish_atrium(Scene& scene, std::uint64_t seed) {
    add_niche_things(scene);
    add_lanterns(scene);
    add_cloth(scene, seed);
    add_plants(scene, seed);
}

}  // namespace kilolux
