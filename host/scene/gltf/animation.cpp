// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/animation.h"

#include <algorithm>

#include "host/scene/gltf/json/animated_property.h"
#include "host/scene/gltf/mesh/accessor.h"

namespace kilolux {
namespace {

using Values = std::vector<double>;  // of one key: up to 4, or as many as there are morph targets

enum class Interpolation { step, linear, cubic };

// A channel's key times and values.
struct Track {
    std::span<const float> times;  // [s], ascending, at least one
    ElementArray output;
    Interpolation interpolation = Interpolation::linear;
    std::size_t per_key = 1;  // output elements of one value
};

// Position of a time between two keys.
struct Span {
    std::size_t first = 0;
    std::size_t second = 0;
    double fraction = 0.0;  // 0 at the first, 1 at the second
    double length = 0.0;    // [s]
};

// Read once: a clip that plays evaluates its tracks at every frame.
const std::vector<float>& read_times(const GltfDocument& document, int accessor) {
    if (const auto read = document.key_times.find(accessor); read != document.key_times.end()) {
        return read->second;
    }
    const ElementArray input = open_accessor(document, accessor);
    expect_components(input, {1}, "an animation's input");
    document.budget->charge(input.count, sizeof(float), input.where);
    std::vector<float> times(input.count);
    for (std::size_t i = 0; i < times.size(); ++i) {
        times[i] = read_scalar(input, i);
        if (i > 0 && times[i] < times[i - 1]) {
            document.fail(element_name("accessors", static_cast<std::size_t>(accessor)),
                          "key time {} is {}, must not be before its predecessor", i, times[i]);
        }
    }
    return document.key_times.emplace(accessor, std::move(times)).first->second;
}

Track open_track(const GltfDocument& document, const AnimatedProperty& property) {
    const tinygltf::Animation& animation = document.model.animations[property.clip];
    const std::string where = element_name("animations", property.clip) + "." +
                              element_name("channels", property.channel);
    const auto index = static_cast<std::size_t>(animation.channels[property.channel].sampler);
    if (index >= animation.samplers.size()) {
        document.fail(where, "sampler is {}, must be below {}", index, animation.samplers.size());
    }
    const tinygltf::AnimationSampler& sampler = animation.samplers[index];
    Track track;
    track.times = read_times(document, sampler.input);
    track.output = open_accessor(document, sampler.output);
    const std::size_t components = std::max<std::size_t>(property.length, 1);
    expect_components(track.output, {components}, "an animation of this path");
    if (sampler.interpolation == "STEP") track.interpolation = Interpolation::step;
    if (sampler.interpolation == "CUBICSPLINE") track.interpolation = Interpolation::cubic;
    if (property.path == kVisibilityPath && track.interpolation != Interpolation::step) {
        document.fail(where, "interpolation must be STEP, since it drives a boolean");
    }
    const std::size_t values_per_key = track.interpolation == Interpolation::cubic ? 3 : 1;
    const std::size_t keys = track.times.size() * values_per_key;
    track.per_key = keys == 0 ? 0 : track.output.count / keys;
    const bool fits = track.per_key >= 1 && (property.length == 0 || track.per_key == 1) &&
                      track.per_key * keys == track.output.count;
    if (!fits) {
        document.fail(where, "output has {} values, which do not go with its {} key times",
                      track.output.count, track.times.size());
    }
    return track;
}

Span find_span(std::span<const float> times, double time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time,
                                        [](double t, float key) { return t < key; });
    if (after == times.begin()) return {};
    const auto second = static_cast<std::size_t>(after - times.begin());
    if (after == times.end()) return {second - 1, second - 1, 0.0, 0.0};
    const double length = static_cast<double>(times[second]) - times[second - 1];
    return {second - 1, second, (time - times[second - 1]) / length, length};
}

// The value `slot` of a key: cubic splines have 0 in-tangent, 1 value, 2 out-tangent; others 0.
Values read_key(const Track& track, std::size_t key, std::size_t slot) {
    const std::size_t slots = track.interpolation == Interpolation::cubic ? 3 : 1;
    Values values;
    for (std::size_t i = 0; i < track.per_key; ++i) {
        const glm::dvec4 element =
            read_exact(track.output, (key * slots + slot) * track.per_key + i);
        for (std::size_t c = 0; c < track.output.components; ++c) {
            values.push_back(element[static_cast<glm::length_t>(c)]);
        }
    }
    return values;
}

// glTF 2.0, appendix C.5 (cubic spline interpolation).
Values cubic(const Track& track, const Span& span) {
    const Values v0 = read_key(track, span.first, 1);
    const Values b0 = read_key(track, span.first, 2);
    const Values a1 = read_key(track, span.second, 0);
    const Values v1 = read_key(track, span.second, 1);
    const double t = span.fraction;
    const double t2 = t * t;
    const double t3 = t2 * t;
    Values out(v0.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = (2 * t3 - 3 * t2 + 1) * v0[i] + span.length * (t3 - 2 * t2 + t) * b0[i] +
                 (-2 * t3 + 3 * t2) * v1[i] + span.length * (t3 - t2) * a1[i];
    }
    return out;
}

glm::dquat quat_of(const Values& v) {
    const glm::dquat q(v[3], v[0], v[1], v[2]);
    const double length = glm::length(q);
    return length > 0.0 ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

Values linear(const Values& a, const Values& b, double fraction, bool is_rotation) {
    if (is_rotation) {
        const glm::dquat q = glm::slerp(quat_of(a), quat_of(b), fraction);
        return {q.x, q.y, q.z, q.w};
    }
    Values out(a.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + (b[i] - a[i]) * fraction;
    return out;
}

Values evaluate(const Track& track, double time, bool is_rotation) {
    const Span span = find_span(track.times, time);
    const bool is_cubic = track.interpolation == Interpolation::cubic;
    if (span.first == span.second || track.interpolation == Interpolation::step) {
        return read_key(track, span.first, is_cubic ? 1 : 0);
    }
    if (is_cubic) return cubic(track, span);
    return linear(read_key(track, span.first, 0), read_key(track, span.second, 0), span.fraction,
                  is_rotation);
}

// At the options' time.
Values value_of(const GltfDocument& document, const AnimatedProperty& property) {
    return evaluate(open_track(document, property), document.options.time,
                    property.array == "nodes" && property.path == "rotation");
}

void assign(NodePose& pose, const std::string& path, Values values) {
    if (path == "weights") {
        pose.weights = std::move(values);
    } else if (path == kVisibilityPath) {
        pose.visibility = values[0] != 0.0 ? NodeVisibility::visible : NodeVisibility::hidden_now;
    } else if (path == "rotation") {
        pose.rotation = quat_of(values);
    } else {
        const glm::dvec3 v(values[0], values[1], values[2]);
        (path == "scale" ? pose.scale : pose.translation) = v;
    }
}

bool needs_no_matrix(const std::string& path) {
    return path != "weights" && path != kVisibilityPath;
}

// The least or the greatest numbers that a track takes: those of its keys, and of a cubic spline
// the control points between them, whose hull holds it.
Values extreme_of(const Track& track, bool greatest) {
    Values out = read_key(track, 0, track.interpolation == Interpolation::cubic ? 1 : 0);
    const auto take = [&](const Values& values, const Values& slope, double length) {
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double value = values[i] + (slope.empty() ? 0.0 : slope[i] * length / 3.0);
            out[i] = greatest ? std::max(out[i], value) : std::min(out[i], value);
        }
    };
    for (std::size_t k = 0; k < track.times.size(); ++k) {
        if (track.interpolation != Interpolation::cubic) {
            take(read_key(track, k, 0), {}, 0.0);
            continue;
        }
        const Values value = read_key(track, k, 1);
        const auto length = [&](std::size_t from) {
            return static_cast<double>(track.times[from + 1]) - track.times[from];
        };
        take(value, {}, 0.0);
        if (k > 0) take(value, read_key(track, k, 0), -length(k - 1));
        if (k + 1 < track.times.size()) take(value, read_key(track, k, 2), length(k));
    }
    return out;
}

}  // namespace

void apply_animations(const GltfDocument& document, std::vector<NodePose>& poses) {
    for (const AnimatedProperty& property : document.animated) {
        if (property.array != "nodes") continue;
        NodePose& pose = poses[property.element];
        if (pose.has_matrix && needs_no_matrix(property.path)) {
            document.leave_out("animations of nodes that have a matrix are left out");
        } else {
            assign(pose, property.path, value_of(document, property));
        }
    }
}

void animate_elements(GltfDocument& document) {
    for (const AnimatedProperty& property : document.animated) {
        if (auto* elements = json_elements(document, property.array)) {
            set_property((*elements)[property.element], property, value_of(document, property));
        } else if (property.array == "meshes") {
            document.model.meshes[property.element].weights = value_of(document, property);
        }
    }
}

bool drives_materials(const GltfDocument& document) {
    return std::ranges::count(document.animated, "materials", &AnimatedProperty::array) > 0;
}

std::vector<Material> extreme_materials(GltfDocument& document) {
    std::vector<Material> out;
    for (const bool greatest : {false, true}) {
        for (const AnimatedProperty& property : document.animated) {
            if (property.array != "materials") continue;
            set_property(document.materials[property.element], property,
                         extreme_of(open_track(document, property), greatest));
        }
        const std::vector<Material> extremes = convert_materials(document).materials;
        out.insert(out.end(), extremes.begin(), extremes.end());
    }
    return out;
}

std::set<int> nodes_with_driven_weights(const GltfDocument& document) {
    std::set<int> out;
    for (const AnimatedProperty& property : document.animated) {
        if (property.path != "weights") continue;
        const int element = static_cast<int>(property.element);
        if (property.array == "nodes") out.insert(element);
        for (std::size_t n = 0; property.array == "meshes" && n < document.model.nodes.size();
             ++n) {
            if (document.model.nodes[n].mesh == element) out.insert(static_cast<int>(n));
        }
    }
    return out;
}

}  // namespace kilolux
