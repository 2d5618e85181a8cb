// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/animation.h"

#include <algorithm>

#include "host/scene/gltf/mesh/accessor.h"

namespace kilolux {
namespace {

using Values = std::vector<double>;  // of one key: 3, 4, or as many as there are morph targets

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

Track open_track(const GltfDocument& document, const tinygltf::AnimationSampler& sampler,
                 std::size_t components, const std::string& where) {
    Track track;
    track.times = read_times(document, sampler.input);
    track.output = open_accessor(document, sampler.output);
    expect_components(track.output, {components}, "an animation of this path");
    if (sampler.interpolation == "STEP") track.interpolation = Interpolation::step;
    if (sampler.interpolation == "CUBICSPLINE") track.interpolation = Interpolation::cubic;
    const std::size_t values_per_key = track.interpolation == Interpolation::cubic ? 3 : 1;
    const std::size_t keys = track.times.size() * values_per_key;
    track.per_key = keys == 0 ? 0 : track.output.count / keys;
    const bool fits = track.per_key >= 1 && (components == 1 || track.per_key == 1) &&
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
        const glm::vec4 element =
            read_vector(track.output, (key * slots + slot) * track.per_key + i);
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

// Components of an output of the path; 0 for a path that is not supported.
std::size_t components_of(const std::string& path) {
    if (path == "translation" || path == "scale") return 3;
    if (path == "rotation") return 4;
    return path == "weights" ? 1 : 0;
}

void assign(NodePose& pose, const std::string& path, Values values) {
    if (path == "weights") {
        pose.weights = std::move(values);
    } else if (path == "rotation") {
        pose.rotation = quat_of(values);
    } else {
        const glm::dvec3 v(values[0], values[1], values[2]);
        (path == "scale" ? pose.scale : pose.translation) = v;
    }
}

void apply_channel(const GltfDocument& document, const tinygltf::Animation& animation,
                   const tinygltf::AnimationChannel& channel, const std::string& where,
                   NodePose& pose) {
    const std::size_t components = components_of(channel.target_path);
    if (components == 0) {
        document.leave_out("animations of '" + shown_uri(channel.target_path) + "' are left out");
        return;
    }
    if (pose.has_matrix && channel.target_path != "weights") {
        document.leave_out("animations of nodes that have a matrix are left out");
        return;
    }
    const auto sampler = static_cast<std::size_t>(channel.sampler);
    if (sampler >= animation.samplers.size()) {
        document.fail(where, "sampler is {}, must be below {}", sampler, animation.samplers.size());
    }
    const Track track = open_track(document, animation.samplers[sampler], components, where);
    assign(pose, channel.target_path,
           evaluate(track, document.options.time, channel.target_path == "rotation"));
}

}  // namespace

void apply_animations(const GltfDocument& document, std::vector<NodePose>& poses) {
    std::set<std::pair<int, std::string>> driven;
    for (const std::size_t a : document.clips) {
        const tinygltf::Animation& animation = document.model.animations[a];
        for (std::size_t c = 0; c < animation.channels.size(); ++c) {
            const tinygltf::AnimationChannel& channel = animation.channels[c];
            if (channel.target_node < 0) continue;
            if (!driven.emplace(channel.target_node, channel.target_path).second) continue;
            const std::string where =
                element_name("animations", a) + "." + element_name("channels", c);
            apply_channel(document, animation, channel, where,
                          poses[static_cast<std::size_t>(channel.target_node)]);
        }
    }
}

bool has_animations(const GltfDocument& document) {
    const auto drives = [](const tinygltf::AnimationChannel& c) { return c.target_node >= 0; };
    return std::any_of(document.clips.begin(), document.clips.end(), [&](std::size_t a) {
        const auto& channels = document.model.animations[a].channels;
        return std::any_of(channels.begin(), channels.end(), drives);
    });
}

std::set<int> nodes_with_driven_weights(const GltfDocument& document) {
    std::set<int> nodes;
    for (const std::size_t a : document.clips) {
        for (const auto& channel : document.model.animations[a].channels) {
            if (channel.target_path == "weights") nodes.insert(channel.target_node);
        }
    }
    return nodes;
}

}  // namespace kilolux
