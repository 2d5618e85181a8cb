// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/radiance_header.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr int kMostLines = 1000;  // of a header

// The `count` numbers after "NAME="; empty for a line of another name.
std::vector<double> numbers_of(const std::string& line, const std::string& name, std::size_t count,
                               const std::filesystem::path& file) {
    if (!line.starts_with(name + "=")) return {};
    const std::string text = line.substr(name.size() + 1);
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    std::vector<double> out(count);
    for (double& value : out) {
        if (in >> value && std::isfinite(value)) continue;
        throw Error(
            fmt::format("{}: {} is '{}', must be {} numbers", file.string(), name, text, count));
    }
    return out;
}

// The file's value of a divisor, one for all channels or one for each.
void divide(RadianceHeader& header, const std::vector<double>& values, const char* name,
            const std::filesystem::path& file) {
    for (std::size_t i = 0; i < 3 && !values.empty(); ++i) {
        const double value = values[values.size() == 1 ? 0 : i];
        if (!(value > 0.0)) {
            throw Error(fmt::format("{}: {} is {}, must be > 0", file.string(), name, value));
        }
        header.divisor[static_cast<glm::length_t>(i)] *= value;
    }
}

}  // namespace

RadianceHeader read_radiance_header(const std::filesystem::path& file) {
    RadianceHeader out;
    std::ifstream in(file, std::ios::binary);
    std::string line;
    if (!std::getline(in, line) || !line.starts_with("#?")) return out;
    for (int i = 0; i < kMostLines && std::getline(in, line) && !line.empty(); ++i) {
        divide(out, numbers_of(line, "EXPOSURE", 1, file), "EXPOSURE", file);
        divide(out, numbers_of(line, "COLORCORR", 3, file), "COLORCORR", file);
        const std::vector<double> primaries = numbers_of(line, "PRIMARIES", 8, file);
        if (!primaries.empty()) out.chromaticities.assign(primaries.begin(), primaries.end());
    }
    return out;
}

}  // namespace kilolux
