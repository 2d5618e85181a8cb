// SPDX-License-Identifier: Apache-2.0
#include "present/image/image_notes.h"

#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <sstream>

namespace kilolux {
namespace {

// Readers of HDR files take lines of 127 bytes, or of fewer than 512, at once.
constexpr std::size_t kCommentBytes = 100;
constexpr const char* kComment = "# ";
constexpr const char* kContinued = "#+";  // goes on with the comment before it

std::string attribute_name(const std::string& name) { return "kilolux:" + name; }

// A line for each note.
std::string note_lines(const ImageNotes& notes) {
    std::string out;
    for (const auto& [name, text] : notes.strings) {
        std::string line = attribute_name(name) + "=" + text;
        std::ranges::replace(line, '\n', ' ');
        out += (out.empty() ? "" : "\n") + line;
    }
    return out;
}

std::string note_in_text(const std::string& text, const std::string& name) {
    const std::string start = attribute_name(name) + "=";
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(start)) return line.substr(start.size());
    }
    return "";
}

// The comments of an HDR file's header, those that go on joined.
std::string comments_in(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string out;
    for (std::string line; std::getline(in, line) && !line.empty();) {
        if (line.starts_with(kContinued)) {
            out += line.substr(2);
        } else if (line.starts_with(kComment)) {
            out.append("\n").append(line, 2);
        }
    }
    return out;
}

}  // namespace

void add_notes(ImageLayout& layout, const ImageNotes& notes, NoteForm form) {
    if (form == NoteForm::attributes) {
        for (const auto& [name, text] : notes.strings) {
            layout.attributes.emplace_back(attribute_name(name), text);
        }
    } else if (form == NoteForm::description && !notes.strings.empty()) {
        layout.attributes.emplace_back("ImageDescription", note_lines(notes));
    }
}

void drop_note(ImageLayout& layout, const std::string& name) {
    std::erase_if(layout.attributes,
                  [&](const auto& a) { return a.first == attribute_name(name); });
    for (auto& [attribute, value] : layout.attributes) {
        auto* text = std::get_if<std::string>(&value);
        if (attribute != "ImageDescription" || text == nullptr) continue;
        const std::size_t at = text->find(fmt::format("\n{}=", attribute_name(name)));
        if (at != std::string::npos) text->erase(at, text->find('\n', at + 1) - at);
    }
}

void insert_comments(std::vector<unsigned char>& hdr, const ImageNotes& notes) {
    std::string comments;
    std::istringstream lines(note_lines(notes));
    for (std::string line; std::getline(lines, line);) {
        for (std::size_t i = 0; i < line.size(); i += kCommentBytes) {
            comments += (i == 0 ? kComment : kContinued) + line.substr(i, kCommentBytes) + "\n";
        }
    }
    hdr.insert(std::ranges::find(hdr, '\n') + 1, comments.begin(), comments.end());
}

std::string note_of_form(const std::filesystem::path& file, const ImageLayout& layout,
                         const std::string& name, NoteForm form) {
    if (form == NoteForm::comments) return note_in_text(comments_in(file), name);
    const std::string key =
        form == NoteForm::attributes ? attribute_name(name) : "ImageDescription";
    for (const auto& [attribute, value] : layout.attributes) {
        if (attribute != key) continue;
        const auto* text = std::get_if<std::string>(&value);
        if (text == nullptr) continue;
        return form == NoteForm::attributes ? *text : note_in_text(*text, name);
    }
    return "";
}

}  // namespace kilolux
