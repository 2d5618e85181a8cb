// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/scene/gltf/files.h"

namespace kilolux {

/// Levels of arrays and objects: deeper than any real file. Limited because readers of JSON may
/// recurse.
constexpr std::size_t kDeepestJson = 100;

/// A long data URI of a file's JSON. Its bytes are decoded where its text stood, and the JSON names
/// it by a short text.
struct DataUri {
    std::string name;       // what the JSON holds: the URI's beginning, "#", its number and a key
    ByteSpan bytes;         // of the file's memory
    std::string broken{};   // what is wrong with its base64; empty if nothing is
    std::size_t begin = 0;  // of the name in the JSON
    std::size_t saved = 0;  // characters that the name is shorter than the URI
};

/// The JSON of a file before it is parsed.
struct JsonText {
    std::string_view text;
    std::string short_text;     // what `text` points into where there are long data URIs
    std::vector<DataUri> data;  // by their numbers
    std::size_t depth = 0;      // the survey ends beyond kDeepestJson
    /// Bound of what nlohmann::json takes to parse it [byte].
    std::uint64_t parsed_bytes = 0;
};

/// Surveys the JSON `text`, a part of `file`, and decodes its long data URIs there. `before` is
/// called with the size of `short_text`.
JsonText survey_json(Bytes& file, std::string_view text, const BeforeBytes& before);

/// Characters of the file that `text` lacks on the line of its character `place`, before that.
std::size_t saved_before(const JsonText& text, std::size_t place);

/// The data URI that a uri of the JSON stands for; nullptr if it stands for itself.
const DataUri* find_data_uri(const std::vector<DataUri>& data, const std::string& uri);

/// Decodes base64 to `out`, which has room for three bytes for each four characters and may be
/// `text` itself. Returns the number of bytes; throws Error "holds broken base64 at its character
/// N".
std::size_t decode_base64(std::string_view text, unsigned char* out);

}  // namespace kilolux
