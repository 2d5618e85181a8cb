// SPDX-License-Identifier: Apache-2.0
// Samplers as glTF defines them: wrap modes, filters, mipmaps, anisotropy, read out of the G-buffer
// and compared with a lookup in double.
#include "tests/raster/gl_fixture.h"
#include "tests/raster/texture_reference.h"

namespace kilolux {
namespace {

using SamplerTest = GlTest;

const GBufferNeeds kSamplerNeeds = make_needs(GBUFFER_FULL);
constexpr int kPixels = 32;  // side of the picture that the quad fills
// Of a value in [0, 1]: hardware filters with 8-bit weights and keeps mipmaps in 8 bits of sRGB,
// which are up to 0.009 apart in light.
constexpr double kSamplerTolerance = 0.012;

const char* name_of(Wrap wrap) {
    return wrap == Wrap::repeat ? "repeat" : wrap == Wrap::clamp ? "clamp" : "mirror";
}

const char* name_of(Filter filter) { return filter == Filter::nearest ? "nearest" : "linear"; }

// A quad that fills the picture, with texture coordinates from `low` to `high`.
Scene textured_quad(const glm::vec2& low, const glm::vec2& high) {
    Mesh mesh = quad_mesh();
    for (glm::vec2& t : mesh.texcoords[0]) t = low + t * (high - low);
    return one_object(mesh);
}

// Largest difference between the picture and the reference. Lookups within 1/100 texel of where
// a nearest one changes are left out.
double largest_error(const HostGBuffer& g, const std::vector<GreyLevel>& levels,
                     const Sampler& sampler, const glm::dvec2& low, const glm::dvec2& high) {
    const glm::dvec2 texels = (high - low) * glm::dvec2(levels[0].width, levels[0].height);
    const double lod = std::log2(std::max(texels.x, texels.y) / kPixels);
    double largest = 0.0;
    for (int y = 0; y < kPixels; ++y) {
        for (int x = 0; x < kPixels; ++x) {
            const glm::dvec2 uv = low + (glm::dvec2(x, y) + 0.5) / double(kPixels) * (high - low);
            const glm::dvec2 near = {0.01 / levels[0].width, 0.01 / levels[0].height};
            const double expected = sample_texture(levels, sampler, uv, lod);
            const double got = g.vector(PLANE_ALBEDO_R, x, y).x;
            double error = std::abs(got - expected);
            for (const glm::dvec2& shift : {near, -near}) {
                error = std::min(error,
                                 std::abs(got - sample_texture(levels, sampler, uv + shift, lod)));
            }
            largest = std::max(largest, error);
        }
    }
    return largest;
}

// Draws noise of width x height texels through the sampler and compares.
double error_of(const Sampler& sampler, int width, int height, const glm::dvec2& low,
                const glm::dvec2& high) {
    const std::vector<int> codes = noise_codes(width, height, 11);
    Scene scene = textured_quad(glm::vec2(low), glm::vec2(high));
    scene.materials[0].base_color_texture = add_texture(scene, width, height, grey_rgba(codes));
    scene.textures[0].sampler = sampler;
    const HostGBuffer g = draw_gbuffer(scene, front_camera(1), kPixels, kPixels, kSamplerNeeds);
    return largest_error(g, grey_levels(width, height, codes), sampler, low, high);
}

TEST_F(SamplerTest, EveryWrapModeBothWaysWithBothFilters) {
    // Every mode along either axis; with another one along the other, as they do not mix.
    for (const auto& [s, t] :
         {std::pair(Wrap::repeat, Wrap::clamp), std::pair(Wrap::clamp, Wrap::mirror),
          std::pair(Wrap::mirror, Wrap::repeat)}) {
        for (const Filter filter : {Filter::nearest, Filter::linear}) {
            // Magnified: 16 x 8 texels in 32 x 32 pixels, two periods to either side.
            const Sampler sampler{s, t, filter, Filter::nearest, false, {}};
            EXPECT_LT(error_of(sampler, 4, 2, {-1.53, -1.47}, {2.47, 2.53}), kSamplerTolerance)
                << name_of(s) << " " << name_of(t) << " " << name_of(filter);
        }
    }
}

TEST_F(SamplerTest, MagnifyAndMinifyHaveTheirOwnFilter) {
    for (const Filter magnify : {Filter::nearest, Filter::linear}) {
        for (const Filter minify : {Filter::nearest, Filter::linear}) {
            const Sampler sampler{Wrap::repeat, Wrap::repeat, magnify, minify, false, {}};
            const std::string name = std::string(name_of(magnify)) + " " + name_of(minify);
            EXPECT_LT(error_of(sampler, 16, 16, {0.01, 0.02}, {1.01, 1.02}), kSamplerTolerance)
                << name << " magnified";
            EXPECT_LT(error_of(sampler, 256, 256, {0.01, 0.02}, {1.01, 1.02}), kSamplerTolerance)
                << name << " minified, no mipmaps";
        }
    }
}

TEST_F(SamplerTest, MipmapsAreChosenByTheMinifyFilter) {
    // A pixel is 2^lod texels wide. Drivers choose a level with some slack, and blend two of them
    // the same way everywhere only half-way.
    const auto expect = [&](Filter minify, Filter between, double lod) {
        const Sampler sampler{Wrap::repeat, Wrap::repeat, Filter::linear, minify, true, between};
        const double span = kPixels * std::exp2(lod) / 256;
        EXPECT_LT(error_of(sampler, 256, 256, {0.011, 0.023}, {0.011 + span, 0.023 + span}),
                  between == Filter::linear ? 2 * kSamplerTolerance : kSamplerTolerance)
            << name_of(minify) << ", between mipmaps " << name_of(between) << ", lod " << lod;
    };
    for (const Filter minify : {Filter::nearest, Filter::linear}) {
        for (const double lod : {0.9, 1.25, 1.75, 2.25, 3.0}) expect(minify, Filter::nearest, lod);
        for (const double lod : {1.0, 1.5, 2.0, 2.5, 3.0}) expect(minify, Filter::linear, lod);
    }
}

// A checkerboard of single texels, farther than its texels can be told apart.
HostGBuffer far_checkerboard(bool mipmaps, Filter filter) {
    std::vector<int> codes;
    for (int i = 0; i < 256 * 256; ++i) codes.push_back((i + i / 256) % 2 == 0 ? 255 : 0);
    Scene scene = one_object(quad_mesh(), {}, translation({0.013, 0.007, -6.1}));
    scene.materials[0].base_color_texture = add_texture(scene, 256, 256, grey_rgba(codes));
    scene.textures[0].sampler = {Wrap::repeat, Wrap::repeat, filter, filter, mipmaps, filter};
    return draw_gbuffer(scene, front_camera(1), 256, 256, kSamplerNeeds);
}

TEST_F(SamplerTest, AFarCheckerboardIsGreyWithMipmapsAndTexelsWithout) {
    const HostGBuffer smooth = far_checkerboard(true, Filter::linear);
    const HostGBuffer raw = far_checkerboard(false, Filter::nearest);
    int white = 0;
    int black = 0;
    for (int y = 115; y < 140; ++y) {
        for (int x = 115; x < 140; ++x) {
            // The mean of the light, not of the codes, which would be 0.21.
            EXPECT_NEAR(smooth.vector(PLANE_ALBEDO_R, x, y).x, 0.5, 0.01) << x << ", " << y;
            const double texel = raw.vector(PLANE_ALBEDO_R, x, y).x;
            white += texel == 1.0 ? 1 : 0;
            black += texel == 0.0 ? 1 : 0;
        }
    }
    EXPECT_EQ(white + black, 25 * 25) << "texels as they are";
    EXPECT_GT(std::min(white, black), 100) << white << " white, " << black << " black";
}

TEST_F(SamplerTest, BelongsToTheTextureNotToTheImage) {
    Scene scene = textured_quad({0, 0}, {2, 1});
    Material& material = scene.materials[0];
    material.base_color_texture = add_texture(scene, 2, 1, {255, 0, 0, 255, 0, 255, 0, 255});
    material.emissive = glm::vec3(1.0f);
    material.emissive_texture = material.base_color_texture;
    material.emissive_texture.texture = 1;
    scene.textures.push_back(scene.textures[0]);
    scene.textures[1].sampler.wrap_s = Wrap::clamp;
    const HostGBuffer g = draw_gbuffer(scene, front_camera(1), kPixels, kPixels, kSamplerNeeds);
    EXPECT_EQ(g.vector(PLANE_ALBEDO_R, 20, 8), glm::dvec3(1, 0, 0)) << "repeats";
    EXPECT_EQ(g.vector(PLANE_EMISSIVE_R, 20, 8), glm::dvec3(0, 1, 0)) << "stays at its edge";
    EXPECT_EQ(GpuScene(scene).image_count(), 1u);
}

// A floor of stripes that run away from the camera, seen at a grazing angle.
class AnisotropyTest : public GlTest {
 protected:
    static constexpr int kSide = 512;  // of the texture [texel]

    // Draws stripes of 4 texels that vary with u or v, where a pixel is about 1.5 texels wide and
    // 12 deep; the standard deviation of what is seen.
    double contrast(int anisotropy, bool along_u, Filter filter = Filter::linear) {
        std::vector<int> codes;
        for (int i = 0; i < kSide * kSide; ++i) {
            codes.push_back(((along_u ? i : i / kSide) / 4) % 2 == 0 ? 255 : 0);
        }
        Scene scene = one_object(quad_mesh(), {}, floor());
        scene.materials[0].base_color_texture = add_texture(scene, kSide, kSide, grey_rgba(codes));
        const bool mipmaps = filter == Filter::linear;
        scene.textures[0].sampler = {Wrap::clamp, Wrap::clamp, filter, filter, mipmaps, filter};
        const GpuScene gpu(scene, anisotropy);
        GeometryPass pass(gpu, kSamplerNeeds);
        const Camera camera = look_at({0, 0.12, 1}, {0, 0, 0}, {0, 1, 0}, glm::radians(40.0));
        pass.draw(camera, 128, 128);
        const uint stride = view_of(camera, 128, 128).stride;
        const GBufferLayout layout = make_gbuffer_layout(kSamplerNeeds, stride, 128);
        picture_ = {layout, stride, read_gbuffer(pass.targets(), layout, stride)};
        double sum = 0.0;
        double squares = 0.0;
        int count = 0;
        for (int y = 56; y < 72; ++y) {
            for (int x = 40; x < 88; ++x) {
                const double value = picture_.vector(PLANE_ALBEDO_R, x, y).x;
                sum += value;
                squares += value * value;
                ++count;
            }
        }
        mean_ = sum / count;
        return std::sqrt(squares / count - mean_ * mean_);
    }

    // The unit quad laid down: its +y goes away from the camera, +z up.
    static glm::dmat4 floor() {
        glm::dmat4 m(1.0);
        m[1] = {0, 0, -1, 0};
        m[2] = {0, 1, 0, 0};
        return m;
    }

    HostGBuffer picture_;  // of the latest contrast()
    double mean_ = 0.0;
};

TEST_F(AnisotropyTest, KeepsStripesThatRunAway) {
    const double isotropic = contrast(1, true);
    const double filtered = contrast(8, true);
    EXPECT_NEAR(mean_, 0.5, 0.05);
    EXPECT_LT(isotropic, 0.1);
    EXPECT_GT(filtered, 0.3);
}

TEST_F(AnisotropyTest, StillBlursStripesThatLieAcross) {
    EXPECT_LT(contrast(1, false), 0.15);
    EXPECT_NEAR(mean_, 0.5, 0.1);
    EXPECT_LT(contrast(8, false), 0.4);
}

TEST_F(AnisotropyTest, LeavesNearestLookupsAlone) {
    contrast(1, true, Filter::nearest);
    const std::vector<std::byte> without = picture_.bytes;
    contrast(8, true, Filter::nearest);
    EXPECT_TRUE(without == picture_.bytes);
}

}  // namespace
}  // namespace kilolux
