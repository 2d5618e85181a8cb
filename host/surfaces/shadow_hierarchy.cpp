// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/shadow_hierarchy.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <type_traits>

#include "host/base/error.h"

namespace kilolux {
namespace {

struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct BvhDeleter {
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
using DeviceOwner = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceDeleter>;
using BvhOwner = std::unique_ptr<std::remove_pointer_t<RTCBVH>, BvhDeleter>;

// A node as Embree's builder makes it, allocated by Embree.
struct BuiltNode {
    uint count;  // of children; 0: a leaf
    uint box;    // of a leaf
    std::array<BuiltNode*, SHADOW_WIDTH> children;
    std::array<RTCBounds, SHADOW_WIDTH> bounds;
};

void* make_node(RTCThreadLocalAllocator allocator, unsigned children, void*) {
    auto* node = static_cast<BuiltNode*>(
        rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode)));
    node->count = children;
    return node;
}

void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) {
        static_cast<BuiltNode*>(node)->children.at(i) = static_cast<BuiltNode*>(children[i]);
    }
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<BuiltNode*>(node)->bounds.at(i) = *bounds[i];
}

void* make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t,
                void*) {
    auto* leaf = static_cast<BuiltNode*>(
        rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode)));
    leaf->count = 0;
    leaf->box = primitives->primID;
    return leaf;
}

ShadowNode empty_node() {
    ShadowNode node{};
    for (auto* ends : {&node.low_x, &node.low_y, &node.low_z}) {
        std::fill(std::begin(*ends), std::end(*ends), SHADOW_NOWHERE);
    }
    for (auto* ends : {&node.high_x, &node.high_y, &node.high_z}) {
        std::fill(std::begin(*ends), std::end(*ends), -SHADOW_NOWHERE);
    }
    return node;
}

void set_child(ShadowNode& node, std::size_t i, const float* low, const float* high, uint child) {
    node.low_x[i] = low[0];
    node.low_y[i] = low[1];
    node.low_z[i] = low[2];
    node.high_x[i] = high[0];
    node.high_y[i] = high[1];
    node.high_z[i] = high[2];
    node.child[i] = child;
}

// Appends `from` and its descendants.
uint flatten(const BuiltNode& from, std::span<const CasterBox> boxes, int level,
             std::vector<ShadowNode>& nodes) {
    if (level >= SHADOW_LEVELS) {
        throw Error(fmt::format("shadows: the hierarchy of triangles has more than {} levels",
                                SHADOW_LEVELS));
    }
    const std::size_t place = nodes.size();
    nodes.push_back(empty_node());
    for (std::size_t i = 0; i < from.count; ++i) {
        const BuiltNode& child = *from.children.at(i);
        if (child.count == 0) {
            const CasterBox& box = boxes[child.box];
            set_child(nodes[place], i, box.low, box.high, box.child);
            continue;
        }
        const uint number = flatten(child, boxes, level + 1, nodes);
        const RTCBounds& bounds = from.bounds.at(i);
        set_child(nodes[place], i, &bounds.lower_x, &bounds.upper_x, number);
    }
    return static_cast<uint>(place);
}

std::vector<RTCBuildPrimitive> primitives_of(std::span<const CasterBox> boxes) {
    std::vector<RTCBuildPrimitive> out(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const CasterBox& box = boxes[i];
        out[i] = {box.low[0],  box.low[1],  box.low[2],  0,
                  box.high[0], box.high[1], box.high[2], static_cast<unsigned>(i)};
    }
    return out;
}

const BuiltNode* build(RTCDevice device, RTCBVH bvh, std::vector<RTCBuildPrimitive>& primitives) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof(arguments);
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = SHADOW_WIDTH;
    arguments.maxDepth = SHADOW_LEVELS;
    arguments.sahBlockSize = 1;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 1;
    arguments.bvh = bvh;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = make_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = make_leaf;
    const auto* root = static_cast<const BuiltNode*>(rtcBuildBVH(&arguments));
    if (root == nullptr) {
        throw Error(
            fmt::format("shadows: building the hierarchy of {} triangles failed (Embree error {})",
                        primitives.size(), static_cast<int>(rtcGetDeviceError(device))));
    }
    return root;
}

}  // namespace

std::vector<ShadowNode> build_shadow_hierarchy(std::span<const CasterBox> boxes) {
    std::vector<ShadowNode> nodes;
    if (boxes.empty()) return {empty_node()};
    if (boxes.size() == 1) {
        nodes.push_back(empty_node());
        set_child(nodes.front(), 0, boxes[0].low, boxes[0].high, boxes[0].child);
        return nodes;
    }
    const DeviceOwner device(rtcNewDevice(nullptr));
    if (!device) throw Error("shadows: Embree has no device");
    const BvhOwner bvh(rtcNewBVH(device.get()));
    std::vector<RTCBuildPrimitive> primitives = primitives_of(boxes);
    const BuiltNode* root = build(device.get(), bvh.get(), primitives);
    flatten(*root, boxes, 0, nodes);
    return nodes;
}

uint level_count(std::span<const ShadowNode> nodes) {
    std::vector<uint> levels(nodes.size(), 1);  // of each node, the root's is 1
    uint most = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        most = std::max(most, levels[i]);
        for (std::size_t j = 0; j < SHADOW_WIDTH; ++j) {
            const bool is_there = nodes[i].low_x[j] <= nodes[i].high_x[j];
            const uint child = nodes[i].child[j];
            if (is_there && (child & SHADOW_LEAF) == 0u) levels.at(child) = levels[i] + 1;
        }
    }
    return most;
}

}  // namespace kilolux
