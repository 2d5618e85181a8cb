// SPDX-License-Identifier: Apache-2.0
// Extensions that are left out, LoadOptions::strict, and variants of materials.
#include <gtest/gtest.h>

#include <cmath>

#include "host/base/error.h"
#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

GltfBuilder file_with(const json& used, const json& required) {
    GltfBuilder file = triangle_file();
    file.root["extensionsUsed"] = used;
    file.root["extensionsRequired"] = required;
    return file;
}

std::string warning_of(const GltfBuilder& file) {
    testing::internal::CaptureStderr();
    load(file);
    return testing::internal::GetCapturedStderr();
}

std::string strict_error(const GltfBuilder& file) {
    LoadOptions options;
    options.strict = true;
    const TempFolder folder;
    write_file(folder.path() / "scene.gltf", file.gltf());
    return load_error(folder.path() / "scene.gltf", options);
}

GltfBuilder file_with_spots(const std::vector<json>& cones) {
    GltfBuilder file = triangle_file();
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array();
    for (const json& cone : cones) {
        file.root["extensions"]["KHR_lights_punctual"]["lights"].push_back(
            {{"type", "spot"}, {"spot", cone}});
    }
    return file;
}

TEST(LoadSceneExtensions, OneWarningNamesWhatIsLeftOutAndHowItShows) {
    const json names = {"KHR_materials_iridescence", "KHR_materials_dispersion",
                        "KHR_texture_transform", "ACME_glitter", "KHR_xmp_json_ld"};
    const std::string warning =
        warning_of(file_with(names, {"KHR_materials_iridescence", "KHR_texture_transform"}));
    EXPECT_TRUE(
        contains(warning,
                 "scene.gltf: left out: KHR_materials_iridescence (thin films show no colours), "
                 "KHR_materials_dispersion (glass shows no rainbow), "
                 "ACME_glitter (not supported)\n"))
        << warning;
    EXPECT_EQ(std::count(warning.begin(), warning.end(), '\n'), 1) << warning;
    EXPECT_EQ(warning_of(file_with({"KHR_xmp_json_ld"}, {"KHR_xmp_json_ld"})), "");
}

TEST(LoadSceneExtensions, GlassSaysWhatItLacks) {
    GltfBuilder file = triangle_file();
    const auto glass = [&](double roughness, double thickness) {
        file.root["materials"] = {{{"name", "pane"},
                                   {"pbrMetallicRoughness", {{"roughnessFactor", roughness}}},
                                   {"extensions",
                                    {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
                                     {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}}};
        return warning_of(file);
    };
    EXPECT_EQ(glass(0.1, 0.0), "");
    EXPECT_TRUE(contains(glass(0.5, 0.0),
                         "material 'pane': rough glass does not blur what is behind it\n"));
    EXPECT_TRUE(contains(glass(0.0, 2.0), "material 'pane': thick glass does not bend light\n"));
    const Material pane = load(file).materials.at(0);
    EXPECT_EQ(pane.transmission, 0.75f);
    EXPECT_EQ(pane.thickness, 2.0f);
    EXPECT_TRUE(std::isinf(pane.attenuation_distance));
    EXPECT_TRUE(is_blended(pane));
}

TEST(LoadSceneExtensions, AFileThatRequiresAMaterialsExtensionLoads) {
    for (const char* name :
         {"clearcoat", "sheen", "transmission", "volume", "iridescence", "anisotropy", "dispersion",
          "diffuse_transmission", "volume_scatter"}) {
        const std::string extension = std::string("KHR_materials_") + name;
        EXPECT_EQ(load_error(file_with({extension}, {extension})), "") << name;
    }
}

TEST(LoadSceneExtensions, RefusesWhatItCannotDoWithout) {
    const std::string error = load_error(file_with(json::array(), {"KHR_texture_basisu"}));
    EXPECT_TRUE(contains(error, "; gltf-transform ktxdecompress in.glb out.glb decodes it"))
        << error;
}

TEST(LoadSceneExtensions, StrictRefusesWhateverThePictureLacks) {
    EXPECT_EQ(strict_error(triangle_file()), "");
    const std::string error = strict_error(file_with({"KHR_materials_iridescence"}, json::array()));
    EXPECT_TRUE(contains(
        error,
        "scene.gltf: --strict: left out: KHR_materials_iridescence (thin films show no colours)"))
        << error;
    GltfBuilder file = triangle_file();
    file.primitive()["attributes"].erase("POSITION");
    EXPECT_EQ(load_error(file), "");
    EXPECT_TRUE(contains(strict_error(file), "--strict: primitives without positions"));
}

// Primitive 0 is red, and blue in "night"; primitive 1 has no variants.
GltfBuilder variants_file() {
    GltfBuilder file = triangle_file();
    for (const char* name : {"red", "blue"}) file.add("materials", {{"name", name}});
    json plain = file.primitive();
    plain["material"] = 0;
    file.primitive() = plain;
    file.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 0}, {"variants", {0, 2}}}, {{"material", 1}, {"variants", {1}}}};
    file.root["meshes"][0]["primitives"].push_back(plain);
    file.root["extensions"]["KHR_materials_variants"]["variants"] = {
        {{"name", "day"}}, {{"name", "night"}}, {{"name", "dusk"}}};
    return file;
}

std::vector<int> materials_of(const std::string& variant) {
    LoadOptions options;
    options.variant = variant;
    std::vector<int> out;
    for (const Mesh& mesh : load(variants_file(), options).meshes) out.push_back(mesh.material);
    return out;
}

TEST(LoadSceneVariants, GiveThePrimitivesTheirMaterials) {
    EXPECT_EQ(materials_of(""), (std::vector<int>{0, 0}));
    EXPECT_EQ(materials_of("night"), (std::vector<int>{1, 0}));
    EXPECT_EQ(materials_of("1"), (std::vector<int>{1, 0}));
    EXPECT_EQ(materials_of("dusk"), (std::vector<int>{0, 0}));
    EXPECT_EQ(load(variants_file()).variants, (std::vector<std::string>{"day", "night", "dusk"}));
}

TEST(LoadSceneVariants, UnknownNamesAreRefusedWithTheNearest) {
    const std::string error = message_of<UsageError>([] { materials_of("nigth"); });
    EXPECT_TRUE(contains(error, "--variant: 'nigth' is none of the variants of ")) << error;
    EXPECT_TRUE(contains(error, "did you mean 'night'?")) << error;
}

TEST(LoadSceneVariants, TheirIndicesAreChecked) {
    const auto error_with = [](const char* pointer, const json& value) {
        GltfBuilder file = variants_file();
        file.root[json::json_pointer(pointer)] = value;
        return load_error(file);
    };
    const std::string mapping =
        "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/";
    EXPECT_TRUE(contains(error_with((mapping + "material").c_str(), 2),
                         "material is 2, must be an index into the 2 materials"));
    EXPECT_TRUE(contains(error_with((mapping + "variants/1").c_str(), 3),
                         "variants[1] is 3, must be an index into the 3 variants"));
    EXPECT_TRUE(contains(error_with("/extensions/KHR_materials_variants/variants/0/name", 7),
                         "variants[0].name is 7, must be a string"));
}

TEST(LoadSceneLights, ReportConesThatTheExtensionDoesNotAllow) {
    const json half_turn = {{"innerConeAngle", 0}, {"outerConeAngle", 1.5707963705062866}};
    EXPECT_EQ(warning_of(file_with_spots({json::object(), half_turn})), "") << "rounded to a float";
    const json wrong[] = {{{"outerConeAngle", 4}},
                          {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}},
                          {{"innerConeAngle", -0.1}},
                          {{"outerConeAngle", -1}},
                          {{"innerConeAngle", 1}}};
    for (const json& cone : wrong) {
        const GltfBuilder file = file_with_spots({half_turn, cone});
        for (const std::string& said : {warning_of(file), strict_error(file)}) {
            EXPECT_TRUE(contains(said, "scene.gltf: ") &&
                        contains(said, "lights[1]: inner cone ") &&
                        contains(said, ": must be 0 <= inner < outer <= pi / 2"))
                << said;
        }
    }
    const std::string many = warning_of(file_with_spots({wrong[0], wrong[1], half_turn, wrong[2]}));
    EXPECT_TRUE(contains(many, "lights[0]: inner cone 0, outer cone 4: must be ")) << many;
    EXPECT_TRUE(contains(many, "pi / 2; likewise 2 more\n")) << many;
    EXPECT_EQ(std::ranges::count(many, '\n'), 1);
}

}  // namespace
}  // namespace kilolux
