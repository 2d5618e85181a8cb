// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/choices.h"

#include <algorithm>
#include <numeric>

#include "host/base/log.h"
#include "host/base/suggest.h"
#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/json/animated_property.h"
#include "host/scene/gltf/mesh/accessor.h"

namespace kilolux {
namespace {

using Names = std::vector<std::string>;

constexpr const char* kVariants = "KHR_materials_variants";

// "0 'walk', 1 'run'".
std::string listed(const Names& names) {
    constexpr std::size_t kMost = 12;
    std::string out;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
        out += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, shown_uri(names[i]));
    }
    if (names.size() > kMost) out += fmt::format(" and {} more", names.size() - kMost);
    return names.empty() ? "none" : out;
}

// The element that a text names, or whose index it is where no name equals it.
std::size_t find_named(const std::string& text, const Names& names, const std::string& option,
                       const std::string& kind) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found != names.end()) {
        if (std::find(found + 1, names.end(), text) != names.end()) {
            throw UsageError(
                fmt::format("{}: several {} are named '{}': say which by index; "
                            "there are {}",
                            option, kind, shown_uri(text), listed(names)));
        }
        return static_cast<std::size_t>(found - names.begin());
    }
    const bool is_number = !text.empty() && text.size() < 10 &&
                           text.find_first_not_of("0123456789") == std::string::npos;
    if (is_number && std::stoul(text) < names.size()) return std::stoul(text);
    throw UsageError(fmt::format("{}: '{}' is none of the {}: {}{}", option, shown_uri(text), kind,
                                 listed(names), did_you_mean(text, names)));
}

Names clip_names(const GltfDocument& document) {
    Names names;
    for (const tinygltf::Animation& a : document.model.animations) names.push_back(a.name);
    return names;
}

// The material that a primitive's mappings give a variant.
int material_of(const tinygltf::Value& mappings, std::size_t variant, int otherwise) {
    for (std::size_t i = 0; i < mappings.ArrayLen(); ++i) {
        const tinygltf::Value& mapping = mappings.Get(static_cast<int>(i));
        const std::vector<double> variants = numbers_member(mapping, "variants");
        if (std::find(variants.begin(), variants.end(), static_cast<double>(variant)) !=
            variants.end()) {
            return member_or(mapping, "material", otherwise);
        }
    }
    return otherwise;
}

// Seconds from 0 to an animation's last key.
double length_of(const GltfDocument& document, const tinygltf::Animation& animation) {
    double length = 0.0;
    for (const tinygltf::AnimationSampler& sampler : animation.samplers) {
        const ElementArray times = open_accessor(document, sampler.input);
        if (times.count == 0) continue;
        length = std::max<double>(length, read_scalar(times, times.count - 1));
    }
    return length;
}

std::vector<std::size_t> asked_clips(const GltfDocument& document) {
    const Names names = clip_names(document);
    const Names& asked = document.options.clips;
    if (asked.empty() && names.size() > 1) {
        note(fmt::format("{}: plays clip {} of {}; --clip chooses others", document.base.file,
                         clip_name(document, 0), names.size()));
    }
    if (asked.empty())
        return names.empty() ? std::vector<std::size_t>{} : std::vector{std::size_t{0}};
    std::vector<std::size_t> clips;
    for (const std::string& text : asked) {
        const bool named = std::find(names.begin(), names.end(), text) != names.end();
        if (!named && text == "none") continue;
        if (!named && text == "all") {
            clips.resize(names.size());
            std::iota(clips.begin(), clips.end(), std::size_t{0});
            break;
        }
        const std::size_t clip =
            find_named(text, names, "--clip", "animations of " + document.base.file);
        if (std::find(clips.begin(), clips.end(), clip) == clips.end()) clips.push_back(clip);
    }
    return clips;
}

}  // namespace

std::string clip_name(const GltfDocument& document, std::size_t clip) {
    const std::string& name = document.model.animations[clip].name;
    return name.empty() ? element_name("animations", clip) : fmt::format("'{}'", shown_uri(name));
}

std::vector<std::size_t> choose_clips(const GltfDocument& document) {
    std::vector<std::size_t> clips = asked_clips(document);
    for (const auto& [clip, why] : document.broken_animations) {
        if (std::ranges::count(clips, clip) > 0) throw Error(why);
    }
    return clips;
}

std::vector<std::string> list_variants(const GltfDocument& document) {
    Names names;
    const auto* root = find_extension(document.model.extensions, kVariants);
    if (root == nullptr || !root->Has("variants")) return names;
    const tinygltf::Value& variants = root->Get("variants");
    for (std::size_t i = 0; i < variants.ArrayLen(); ++i) {
        names.push_back(member_or<std::string>(variants.Get(static_cast<int>(i)), "name", ""));
    }
    return names;
}

void apply_variant(GltfDocument& document) {
    if (document.options.variant.empty()) return;
    const std::size_t variant = find_named(document.options.variant, list_variants(document),
                                           "--variant", "variants of " + document.base.file);
    for (tinygltf::Mesh& mesh : document.model.meshes) {
        for (tinygltf::Primitive& primitive : mesh.primitives) {
            const auto* extension = find_extension(primitive.extensions, kVariants);
            if (extension == nullptr || !extension->Has("mappings")) continue;
            primitive.material =
                material_of(extension->Get("mappings"), variant, primitive.material);
        }
    }
}

std::vector<Clip> list_clips(const GltfDocument& document) {
    std::vector<Clip> clips;
    for (const tinygltf::Animation& animation : document.model.animations) {
        Clip clip{animation.name};
        const auto broken = document.broken_animations.find(clips.size());
        if (broken != document.broken_animations.end()) clip.broken = broken->second;
        clip.plays = std::ranges::count(document.clips, clips.size()) > 0;
        try {
            clip.length = length_of(document, animation);
        } catch (const Error& error) {
            if (clip.plays) throw;
            clip.broken = error.what();
        }
        clip.channels = static_cast<std::size_t>(std::ranges::count_if(
            animation.channels,
            [&](const auto& channel) { return animated_property(document, channel).has_value(); }));
        clips.push_back(std::move(clip));
    }
    return clips;
}

}  // namespace kilolux
