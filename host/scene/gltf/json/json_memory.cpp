// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/json/json_memory.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

namespace kilolux {
namespace {

using nlohmann::json;

// Blocks that nlohmann::json allocates [byte].
constexpr std::uint64_t kObject = 64;
constexpr std::uint64_t kMember = 96;
constexpr std::uint64_t kArray = 32;
constexpr std::uint64_t kLeastElements = 32;  // of an array that has any
constexpr std::uint64_t kElement = 16;        // twice in a vector that has just grown
constexpr std::uint64_t kString = 48;
constexpr std::uint64_t kInString = 15;  // characters that std::string holds itself

// Parts of tinygltf's model [byte], with a vector's growth.
// An element of an array of the file; of a node also its pose, its matrices and its place in lists.
constexpr std::uint64_t kModelObject = 1024;
constexpr std::uint64_t kPair = 96;  // of a map of names and numbers
constexpr std::uint64_t kNumber = 16;
constexpr std::uint64_t kExtensionMember = 240;
constexpr std::uint64_t kExtensionElement = 160;

constexpr std::uint64_t kNumberText = 26;  // with its comma

std::uint64_t heap_of_string(std::uint64_t length) { return length > kInString ? length + 32 : 0; }

std::uint64_t text_of_string(std::string_view text) {
    std::uint64_t bytes = 4;  // quotes, comma or colon
    for (const char c : text) {
        bytes += static_cast<unsigned char>(c) < 0x20 ? 6 : c == '"' || c == '\\' ? 2 : 1;
    }
    return bytes;
}

// Extensions become tinygltf::Value, which is larger than other parts of the model.
void add_cost(JsonCost& cost, const json& value, bool in_extension) {
    if (const auto* text = value.get_ptr<const std::string*>()) {
        const std::uint64_t heap = heap_of_string(text->size());
        cost.values += kString + heap;
        cost.model += heap;
        cost.text += text_of_string(*text);
        cost.longest_string = std::max<std::uint64_t>(cost.longest_string, text->size());
    } else if (const auto* array = value.get_ptr<const json::array_t*>()) {
        cost.values += kArray + kElement * (array->capacity() + 1);
        cost.text += 3;
        cost.model += array->size() * (in_extension ? kExtensionElement : kNumber);
        for (const json& element : *array) add_cost(cost, element, in_extension);
    } else if (const auto* object = value.get_ptr<const json::object_t*>()) {
        cost.values += kObject;
        cost.text += 3;
        if (!in_extension) cost.model += kModelObject;
        for (const auto& [key, member] : *object) {
            const std::uint64_t heap = heap_of_string(key.size());
            cost.values += kMember + heap;
            cost.text += text_of_string(key);
            cost.model += heap + (in_extension ? kExtensionMember : member.is_number() ? kPair : 0);
            add_cost(cost, member, in_extension || key == "extensions" || key == "extras");
        }
    } else {
        cost.text += kNumberText;
    }
}

}  // namespace

void JsonCounts::add_string(std::uint64_t length) {
    ++strings;
    longest_string = std::max(longest_string, length);
    string_bytes += heap_of_string(length);
}

// The reader holds the present string twice, each in room for twice as much.
std::uint64_t bound_of_parsed(const JsonCounts& counts) {
    return kObject * counts.objects + kMember * counts.members +
           (kArray + kLeastElements) * counts.arrays +
           2 * kElement * (counts.elements + counts.most_elements) + kString * counts.strings +
           counts.string_bytes + 4 * counts.longest_string;
}

void JsonCost::add(const JsonCost& other) {
    values += other.values;
    text += other.text;
    model += other.model;
    longest_string = std::max(longest_string, other.longest_string);
}

JsonCost cost_of(const json& value) {
    JsonCost cost;
    add_cost(cost, value, false);
    return cost;
}

}  // namespace kilolux
