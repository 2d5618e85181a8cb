// SPDX-License-Identifier: Apache-2.0
// How files of pictures keep notes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/images/images.h"
#include "present/image/image_file.h"

namespace kilolux {

/// Where a format keeps the strings of ImageNotes.
///   attributes   of any name: PNG and EXR
///   description  one text, a line for each: JPEG and TIFF
///   comments     lines of the header that begin with '#': Radiance's HDR
enum class NoteForm { attributes, description, comments };

/// Adds the notes to what is written; of `comments` nothing.
void add_notes(ImageLayout& layout, const ImageNotes& notes, NoteForm form);

/// Removes the note of that name from a file that open_image() read as `layout`; not from comments.
void drop_note(ImageLayout& layout, const std::string& name);

/// Puts the notes into an HDR file's header.
void insert_comments(std::vector<unsigned char>& hdr, const ImageNotes& notes);

/// The note of that name in a file that open_image() read as `layout`; empty where it has none.
std::string note_of_form(const std::filesystem::path& file, const ImageLayout& layout,
                         const std::string& name, NoteForm form);

}  // namespace kilolux
