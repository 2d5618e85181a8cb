// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/atrium.h"

#include <array>
#include <initializer_list>

#include "host/scene/generated/atrium/arch.h"
#include "host/scene/generated/atrium/bay.h"
#include "host/scene/generated/atrium/column.h"
#include "host/scene/generated/atrium/court.h"
#include "host/scene/generated/atrium/furniture.h"
#include "host/scene/generated/atrium/materials.h"
#include "host/scene/generated/atrium/plan.h"
#include "host/scene/generated/atrium/side.h"
#include "host/scene/generated/small.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

using namespace atrium_plan;

MeshBuilder joined(std::initializer_list<MeshBuilder> pieces) {
    MeshBuilder all;
    for (const MeshBuilder& piece : pieces) all.append(piece);
    return all;
}

MeshBuilder rib() {
    MeshBuilder builder;
    add_rib(builder);
    return builder;
}

MeshBuilder bay_vault() {
    MeshBuilder builder;
    add_groin_vault(builder, {0.0, kAisle / 2}, {kHalfBay, kAisle / 2});
    return builder;
}

// A bay's masonry with the column at its left end, one mesh per material.
void add_bays(Scene& scene) {
    const glm::dvec3 left(-kHalfBay, 0.0, 0.0);
    const MeshBuilder gallery_columns =
        joined({gallery_column(), gallery_column().moved({kHalfBay, 0.0, 0.0})});
    const int meshes[] = {
        add_atrium_mesh(scene, "bay-plaster",
                        joined({arcade_wall(), aisle_plaster(), bay_vault(), gallery_wall()}),
                        AtriumMaterial::plaster),
        add_atrium_mesh(scene, "bay-brick", joined({aisle_wall(), gallery_arches()}),
                        AtriumMaterial::brick),
        add_atrium_mesh(scene, "bay-voussoirs", joined({arcade_voussoirs(), gallery_stones()}),
                        AtriumMaterial::voussoir),
        add_atrium_mesh(
            scene, "bay-mouldings",
            joined({arcade_mouldings(), aisle_mouldings(), bay_floor_bands(), rib().moved(left)}),
            AtriumMaterial::limestone),
        add_atrium_mesh(scene, "bay-capital", column_stones().moved(left),
                        AtriumMaterial::limestone),
        add_atrium_mesh(scene, "bay-shafts",
                        joined({column_shaft().moved(left), gallery_columns.moved(left)}),
                        AtriumMaterial::marble),
        add_atrium_mesh(scene, "bay-balustrade", balustrade(), AtriumMaterial::limestone),
        add_atrium_mesh(scene, "bay-tiles", bay_tiles(), AtriumMaterial::tile),
        add_atrium_mesh(scene, "bay-wood", gallery_wood(), AtriumMaterial::wood),
    };
    for (const int mesh : meshes) {
        for (const Place& bay : bays()) place(scene, mesh, bay.world_from_piece);
    }
}

void add_corners(Scene& scene) {
    const int shared[] = {
        add_atrium_mesh(scene, "corner-brick", corner_brick(), AtriumMaterial::brick),
        add_atrium_mesh(scene, "corner-mouldings",
                        joined({corner_mouldings(), corner_floor_bands(), rib()}),
                        AtriumMaterial::limestone),
        add_atrium_mesh(scene, "corner-wood", corner_wood(), AtriumMaterial::wood),
    };
    const int vaulted[] = {
        add_atrium_mesh(scene, "corner-plaster", corner_plaster(false), AtriumMaterial::plaster),
        add_atrium_mesh(scene, "corner-tiles", corner_tiles(false), AtriumMaterial::tile),
    };
    const int with_stair[] = {
        add_atrium_mesh(scene, "stair-plaster", corner_plaster(true), AtriumMaterial::plaster),
        add_atrium_mesh(scene, "stair-tiles", corner_tiles(true), AtriumMaterial::tile),
        add_atrium_mesh(scene, "stair", stair_stones(), AtriumMaterial::marble),
        add_atrium_mesh(scene, "stair-rails", stair_rails(), AtriumMaterial::iron),
    };
    for (const Place& corner : corners()) {
        const glm::dmat4& at = corner.world_from_piece;
        for (const int mesh : shared) place(scene, mesh, at);
        if (corner.side % 2 == 0) {
            for (const int mesh : vaulted) place(scene, mesh, at);
        } else {
            for (const int mesh : with_stair) place(scene, mesh, at);
        }
    }
}

void add_sides(Scene& scene) {
    for (const int parity : {0, 1}) {
        const double half = half_length(parity);
        const int meshes[] = {
            add_atrium_mesh(scene, "cornices", side_cornices(half), AtriumMaterial::limestone),
            add_atrium_mesh(scene, "steps", side_steps(half), AtriumMaterial::limestone),
            add_atrium_mesh(scene, "roof", side_roof(half), AtriumMaterial::terracotta),
            add_atrium_mesh(scene, "eaves", side_eaves(half), AtriumMaterial::wood),
            add_atrium_mesh(scene, "outer-wall", side_outer_wall(half), AtriumMaterial::brick),
        };
        for (const Place& side : sides()) {
            if (side.side % 2 != parity) continue;
            for (const int mesh : meshes) place(scene, mesh, side.world_from_piece);
        }
    }
}

void add_court(Scene& scene) {
    place(scene, add_atrium_mesh(scene, "paving", court_paving(), AtriumMaterial::paving));
    place(scene, add_atrium_mesh(scene, "fountain", fountain_marble(), AtriumMaterial::marble));
    place(scene, add_atrium_mesh(scene, "basin", basin_mosaic(), AtriumMaterial::mosaic));
    place(scene, add_atrium_mesh(scene, "water", fountain_water(), AtriumMaterial::water));
}

using namespace atrium_plan;

constexpr double kPotHeight = 0.56;  // [m] of the soil

void add_niche_things(Scene& scene) {
    const int urn_mesh = add_atrium_mesh(scene, "urn", urn(), AtriumMaterial::terracotta);
    const int bench_mesh = add_atrium_mesh(scene, "bench", bench(), AtriumMaterial::marble);
    for (const Place& bay : bays()) {
        const glm::dvec3 at = is_even(bay) ? glm::dvec3(0.0, 0.46, kAisle + 0.10)
                                           : glm::dvec3(0.0, 0.0, kAisle - 0.42);
        place(scene, is_even(bay) ? urn_mesh : bench_mesh, bay.world_from_piece * placed(at));
    }
}

void add_lanterns(Scene& scene) {
    constexpr double kChain = 1.9;
    const int iron = add_atrium_mesh(scene, "lantern", lantern_iron(kChain), AtriumMaterial::iron);
    const int glass =
        add_atrium_mesh(scene, "lantern-panes", lantern_glass(kChain), AtriumMaterial::glass);
    for (const Place& bay : bays()) {
        if (!is_even(bay)) continue;
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

Scene make_atrium(std::uint64_t seed) {
    Scene scene;
    scene.name = "atrium";
    add_atrium_materials(scene, seed);
    add_bays(scene);
    add_corners(scene);
    add_sides(scene);
    add_court(scene);
    furnish_atrium(scene, seed);
    scene.cameras = {
        camera_from_to("court", {-9.4, 1.35, 0.9}, {3.0, 2.5, -0.7}, 60.0),
        camera_from_to("aisle", {-10.9, 1.7, 6.5}, {2.0, 2.4, 6.7}, 55.0),
        camera_from_to("gallery", {-11.1, 7.5, 0.8}, {0.0, 3.4, -0.9}, 62.0),
        camera_from_to("above", {8.9, 9.3, 3.1}, {-3.5, 0.8, -1.6}, 60.0),
    };
    scene.light_box = {{-15.2, -0.25, -8.8}, {15.2, 9.6, 8.8}};
    return scene;
}

void furnish_atrium(Scene& scene, std::uint64_t seed) {
    add_niche_things(scene);
    add_lanterns(scene);
    add_cloth(scene, seed);
    add_plants(scene, seed);
}

}  // namespace kilolux
