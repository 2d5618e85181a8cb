// SPDX-License-Identifier: Apache-2.0
// The texels of a specular-glossiness material, converted one by one.

#include "host/base/srgb.h"
#include "host/scene/gltf/material/image.h"
#include "host/scene/gltf/material/specular_glossiness.h"
#include "host/scene/gltf/parallel.h"

namespace kilolux {
namespace {

using Table = std::array<float, 256>;

// Reads an image whose colours are sRGB and whose alpha is linear; white without an image.
class SourceImage {
 public:
    SourceImage(const Image* image, const Table& linear) : image_(image), linear_(linear) {}

    int width() const { return image_ == nullptr ? 1 : image_->width; }
    int height() const { return image_ == nullptr ? 1 : image_->height; }

    // Between texels' centres at (u, v) of [0, 1], v downwards; at the image's edge the last texel.
    glm::dvec4 at(double u, double v) const {
        if (image_ == nullptr) return glm::dvec4(1.0);
        const double x = std::clamp(u * width() - 0.5, 0.0, width() - 1.0);
        const double y = std::clamp(v * height() - 0.5, 0.0, height() - 1.0);
        const int x0 = static_cast<int>(x);
        const int y0 = static_cast<int>(y);
        const int x1 = std::min(x0 + 1, width() - 1);
        const int y1 = std::min(y0 + 1, height() - 1);
        return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), x - x0),
                        glm::mix(texel(x0, y1), texel(x1, y1), x - x0), y - y0);
    }

    glm::dvec4 mean() const {
        glm::dvec4 sum(0.0);
        if (image_ == nullptr) return glm::dvec4(1.0);
        for (int y = 0; y < height(); ++y) {
            glm::dvec4 row(0.0);
            for (int x = 0; x < width(); ++x) row += texel(x, y);
            sum += row / static_cast<double>(width());
        }
        return sum / static_cast<double>(height());
    }

 private:
    glm::dvec4 texel(int x, int y) const {
        const std::size_t place =
            4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_->width) +
                 static_cast<std::size_t>(x));
        const std::uint8_t* t = &image_->rgba[place];
        return {linear_[t[0]], linear_[t[1]], linear_[t[2]], t[3] / 255.0};
    }

    const Image* image_;
    const Table& linear_;
};

std::uint8_t code_of(double value) { return static_cast<std::uint8_t>(value * 255.0 + 0.5); }

// A point of both source textures, with the factors.
struct Point {
    SpecularGlossiness surface;
    double alpha = 1.0;
};

Point point_of(const SpecularGlossiness& factors, const glm::dvec4& diffuse,
               const glm::dvec4& glossy) {
    return {{factors.diffuse * glm::dvec3(diffuse), factors.specular * glm::dvec3(glossy),
             factors.glossiness * glossy.w},
            diffuse.w};
}

void write_base_color(const Point& point, std::uint8_t* texel) {
    const glm::dvec3 base = metallic_roughness_of(point.surface).base_color;
    for (glm::length_t c = 0; c < 3; ++c) texel[c] = code_of(linear_to_srgb(base[c]));
    texel[3] = code_of(point.alpha);
}

void write_metallic_roughness(const Point& point, std::uint8_t* texel) {
    const MetallicRoughness made = metallic_roughness_of(point.surface);
    texel[0] = texel[3] = 255;
    texel[1] = code_of(made.roughness);
    texel[2] = code_of(made.metallic);
}

// An image whose texels are what `write` makes of the samples at their centres.
template <typename Sample, typename Write>
Image make_image(const GltfDocument& document, glm::ivec2 size, const Sample& sample,
                 const Write& write) {
    Image out{"", size.x, size.y, {}};
    const auto width = static_cast<std::size_t>(size.x);
    const auto height = static_cast<std::size_t>(size.y);
    document.budget->charge_memory(4 * width * height, document.base.file + ": materials");
    out.rgba.resize(4 * width * height);
    parallel_each(height, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const double u = (static_cast<double>(x) + 0.5) / static_cast<double>(width);
            const double v = (static_cast<double>(y) + 0.5) / static_cast<double>(height);
            write(sample(u, v), &out.rgba[4 * (y * width + x)]);
        }
    });
    return out;
}

std::array<Image, 2> convert(const GltfDocument& document, const ConvertedTextures& job,
                             const Table& linear) {
    std::vector<int> files;
    for (const int image : {job.diffuse, job.specular_glossiness}) {
        if (image >= 0) files.push_back(image);
    }
    const std::vector<Image> images = decode_images(document, files);
    const SourceImage diffuse(job.diffuse >= 0 ? &images.front() : nullptr, linear);
    const SourceImage glossy(job.specular_glossiness >= 0 ? &images.back() : nullptr, linear);
    const glm::ivec2 diffuse_size(diffuse.width(), diffuse.height());
    const glm::ivec2 glossy_size(glossy.width(), glossy.height());
    if (job.same_layout) {
        const auto sample = [&](double u, double v) {
            return point_of(job.factors, diffuse.at(u, v), glossy.at(u, v));
        };
        const glm::ivec2 size = glm::max(diffuse_size, glossy_size);
        return {make_image(document, size, sample, write_base_color),
                make_image(document, size, sample, write_metallic_roughness)};
    }
    const glm::dvec4 mean_diffuse = diffuse.mean();
    const glm::dvec4 mean_glossy = glossy.mean();
    const auto by_diffuse = [&](double u, double v) {
        return point_of(job.factors, diffuse.at(u, v), mean_glossy);
    };
    const auto by_glossy = [&](double u, double v) {
        return point_of(job.factors, mean_diffuse, glossy.at(u, v));
    };
    return {make_image(document, diffuse_size, by_diffuse, write_base_color),
            make_image(document, glossy_size, by_glossy, write_metallic_roughness)};
}

}  // namespace

std::vector<Image> make_converted_images(const GltfDocument& document,
                                         const GltfMaterials& materials) {
    std::vector<Image> out;
    const Table linear = srgb_to_linear_table();
    for (const ConvertedTextures& job : materials.converted) {
        for (Image& image : convert(document, job, linear)) out.push_back(std::move(image));
    }
    return out;
}

}  // namespace kilolux
