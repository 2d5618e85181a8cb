// SPDX-License-Identifier: Apache-2.0
// A `kilolux view --serve` without a display, and the pictures that it must show.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "host/base/text.h"
#include "host/images/images.h"
#include "tests/window/background.h"
#include "tests/window/scripted_window.h"
#include "tests/window/serve/page_client.h"

namespace kilolux {

inline constexpr double kLong = 120.0;  // [s], to compile kernels under load
inline const Variables kNoDisplay = {"-uDISPLAY", "-uWAYLAND_DISPLAY"};

/// The colours of a picture, by rows.
struct ServedPixels {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
    bool operator==(const ServedPixels&) const = default;
};

inline ServedPixels pixels_of(const std::unique_ptr<ImageReader>& image) {
    ServedPixels out{image->layout().width, image->layout().height, {}};
    out.rgb.resize(3 * image->layout().pixels());
    image->read(0, 3, SampleType::uint8, out.rgb.data(), 3);
    return out;
}

/// A session that shows the whole picture: neither panel nor overlay.
class ServedView {
 public:
    explicit ServedView(const std::vector<std::string>& more = {})
        : program_(words(folder_, more)) {
        wait_for("the address is printed", [this] {
            return program_.out().find('\n') != std::string::npos || program_.has_ended();
        });
        address_ = page_address(program_.out());
    }
    Background& program() { return program_; }
    const PageAddress& address() const { return address_; }
    std::string url() const { return program_.out().substr(0, program_.out().find('\n')); }
    /// The settings that it kept at its end.
    std::string kept() const { return text_of_file(folder_ / "kilolux/view.json"); }

 private:
    static std::vector<std::string> words(const TemporaryFolder& folder,
                                          const std::vector<std::string>& more) {
        fs::create_directories(folder / "kilolux");
        write_text(folder / "kilolux/view.json",
                   R"({"version":2,"panel":false,"overlay":false,"samples":1})");
        Variables variables = kNoDisplay;
        variables.push_back("XDG_CONFIG_HOME=" + folder.path().string());
        std::vector<std::string> out = {program_file(), "view",      "plain", "--lights", "150",
                                        "--quiet",      "--samples", "1",     "--serve"};
        out.insert(out.end(), more.begin(), more.end());
        return with_variables(variables, out);
    }

    TemporaryFolder folder_;
    Background program_;
    PageAddress address_;
};

/// The picture that `kilolux render` makes by the words of a copied command.
inline ServedPixels rendered_by(const std::string& command, int width, int height) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out.png";
    std::vector<std::string> words;
    for (const std::string_view word : split(command, ' ')) words.emplace_back(word);
    words.erase(words.begin());  // "kilolux"
    for (const std::string& word :
         {std::string("-o"), out.string(), std::string("-q"), std::string("--resolution"),
          fmt::format("{},{}", width, height)}) {
        words.push_back(word);
    }
    const ChildResult result = run_kilolux(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return pixels_of(open_image(out));
}

}  // namespace kilolux
