// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/json/json_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/text.h"
#include "host/scene/gltf/json/json_memory.h"

namespace kilolux {
namespace {

constexpr std::size_t kLongUri = 4096;     // [character]; shorter ones stay in the JSON
constexpr std::size_t kNameLength = 80;    // what messages show of a URI
constexpr std::size_t kKeyLength = 16;     // of hash_text()
constexpr std::size_t kLongestHead = 256;  // of a data URI, up to its comma

constexpr std::array<std::int8_t, 256> base64_values() {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < kDigits.size(); ++i) {
        values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
    }
    return values;
}

constexpr std::array<std::int8_t, 256> kBase64Values = base64_values();

int base64_value(char digit) { return kBase64Values[static_cast<unsigned char>(digit)]; }

// Where the data of a long base64 data URI begin, or 0 for another text.
std::size_t data_of_long_uri(std::string_view text) {
    if (text.size() < kLongUri || !is_data_uri(text)) return 0;
    const std::size_t comma = text.substr(0, kLongestHead).find(',');
    if (comma == std::string_view::npos) return 0;
    return lower(text.substr(0, comma)).ends_with(";base64") ? comma + 1 : 0;
}

// The end of the string whose contents begin at `begin`.
std::size_t string_end(std::string_view text, std::size_t begin, bool& has_escapes) {
    std::size_t from = begin;
    std::size_t quote = std::min(text.find('"', from), text.size());
    while (true) {
        const std::size_t escape = text.substr(0, quote).find('\\', from);
        if (escape == std::string_view::npos) return quote;
        has_escapes = true;
        from = std::min(escape + 2, text.size());
        if (quote < from) quote = std::min(text.find('"', from), text.size());
    }
}

class Survey {
 public:
    Survey(Bytes& file, std::string_view text)
        : text_(text), bytes_(file.data() + (text.data() - reinterpret_cast<char*>(file.data()))) {}

    JsonText run(const BeforeBytes& before) {
        for (std::size_t i = 0; i < text_.size() && out_.depth <= kDeepestJson; ++i) {
            if (text_[i] == '"') {
                i = take_string(i + 1);
            } else {
                take(text_[i]);
            }
        }
        while (!open_.empty()) close();
        out_.parsed_bytes = bound_of_parsed(counts_);
        out_.text = text_;
        if (!out_.data.empty()) shorten(before);
        return std::move(out_);
    }

 private:
    void take(char c) {
        if (c == '[' || c == '{') {
            open_.push_back(c == '[' ? 1 : 0);
            out_.depth = std::max(out_.depth, open_.size());
            c == '[' ? ++counts_.arrays : ++counts_.objects;
        } else if (c == ',') {
            after_string_ = false;
            if (!open_.empty() && open_.back() > 0) ++open_.back();
        } else if (c == ':') {
            ++counts_.members;
            if (after_string_) --counts_.strings;
            after_string_ = false;
        } else if ((c == ']' || c == '}') && !open_.empty()) {
            close();
        }
    }

    void close() {
        counts_.elements += open_.back();
        counts_.most_elements = std::max(counts_.most_elements, open_.back());
        open_.pop_back();
    }

    // Returns the place of the closing quote.
    std::size_t take_string(std::size_t begin) {
        bool has_escapes = false;
        const std::size_t end = string_end(text_, begin, has_escapes);
        std::size_t length = end - begin;
        const std::string_view text = text_.substr(begin, length);
        if (const std::size_t data = has_escapes ? 0 : data_of_long_uri(text)) {
            add_data_uri(begin, text, data);
            length -= out_.data.back().saved;
        }
        counts_.add_string(length);
        after_string_ = true;
        return end;
    }

    // The first characters of a URI, without half of one.
    static std::string_view head_of(std::string_view uri) {
        std::size_t length = kNameLength;
        while (length > 0 && (static_cast<unsigned char>(uri[length]) & 0xc0u) == 0x80u) --length;
        return uri.substr(0, length);
    }

    void add_data_uri(std::size_t begin, std::string_view text, std::size_t data) {
        DataUri uri;
        uri.name = fmt::format("{}#{}-", head_of(text), out_.data.size());
        uri.begin = begin - saved_;
        uri.saved = text.size() - uri.name.size() - kKeyLength;
        try {
            unsigned char* place = bytes_ + begin + data;
            uri.bytes = {place, decode_base64(text.substr(data), place)};
        } catch (const Error& error) {
            uri.broken = error.what();
        }
        saved_ += uri.saved;
        out_.data.push_back(std::move(uri));
    }

    void shorten(const BeforeBytes& before) {
        before(text_.size() - saved_);
        out_.short_text.reserve(text_.size() - saved_);
        std::size_t from = 0;
        for (const DataUri& uri : out_.data) {
            const std::size_t begin = uri.begin + from - out_.short_text.size();
            out_.short_text += text_.substr(from, begin - from);
            out_.short_text += uri.name + std::string(kKeyLength, ' ');
            from = begin + uri.name.size() + kKeyLength + uri.saved;
        }
        out_.short_text += text_.substr(from);
        // No text of the file is a name by chance: the key depends on all of them.
        const std::string key = hash_text(out_.short_text);
        for (DataUri& uri : out_.data) {
            out_.short_text.replace(uri.begin + uri.name.size(), kKeyLength, key);
            uri.name += key;
        }
        out_.text = out_.short_text;
    }

    std::string_view text_;
    unsigned char* bytes_;  // of text_
    JsonText out_;
    JsonCounts counts_;
    std::vector<std::uint64_t> open_;  // elements of each array around here; 0 for an object
    bool after_string_ = false;
    std::size_t saved_ = 0;  // by shorten(), of what is surveyed
};

}  // namespace

JsonText survey_json(Bytes& file, std::string_view text, const BeforeBytes& before) {
    return Survey(file, text).run(before);
}

std::size_t saved_before(const JsonText& text, std::size_t place) {
    const std::string_view before = text.text.substr(0, place);
    const std::size_t end = before.rfind('\n');
    const std::size_t line = end == std::string_view::npos ? 0 : end + 1;
    std::size_t saved = 0;
    for (const DataUri& uri : text.data) {
        if (uri.begin >= line && uri.begin < place) saved += uri.saved;
    }
    return saved;
}

const DataUri* find_data_uri(const std::vector<DataUri>& data, const std::string& uri) {
    const std::size_t mark = uri.rfind('#');
    if (data.empty() || mark == std::string::npos) return nullptr;
    std::size_t number = 0;
    std::from_chars(uri.data() + mark + 1, uri.data() + uri.size(), number);
    return number < data.size() && data[number].name == uri ? &data[number] : nullptr;
}

std::size_t decode_base64(std::string_view text, unsigned char* out) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    const auto fail = [](std::size_t place) {
        throw Error(fmt::format("holds broken base64 at its character {}", place));
    };
    unsigned char* const begin = out;
    unsigned bits = 0;  // of the last four characters
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int value = base64_value(text[i]);
        if (value < 0) fail(i);
        bits = bits << 6 | static_cast<unsigned>(value);
        if (i % 4 == 0) continue;
        *out++ = static_cast<unsigned char>(bits >> (6 - 2 * (i % 4)));
    }
    if (text.size() % 4 == 1) fail(text.size());
    return static_cast<std::size_t>(out - begin);
}

}  // namespace kilolux
