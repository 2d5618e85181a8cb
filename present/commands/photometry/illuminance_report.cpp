// SPDX-License-Identifier: Apache-2.0
#include "present/commands/photometry/illuminance_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/measure/metrics/compensated_sum.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {
namespace {

using LuxJson = nlohmann::ordered_json;

double lux_of(const Illuminances& result, std::size_t i) {
    const ExactIlluminance* exact = result.exact_of(i);
    return exact != nullptr ? exact->lux : result.kernels[i];
}

constexpr const char* kModel = "direct light, without shadows or interreflection";

using LuxValue = std::optional<double>;

LuxValue illuminance_value(const Illuminances& result, std::size_t i) { return lux_of(result, i); }

LuxValue kernels_value(const Illuminances& result, std::size_t i) { return result.kernels[i]; }

LuxValue float64_value(const Illuminances& result, std::size_t i) {
    const ExactIlluminance* exact = result.exact_of(i);
    return exact != nullptr ? LuxValue(exact->lux) : LuxValue();
}

// Relative to float64's value; none where that is 0.
LuxValue kernel_error(const Illuminances& result, std::size_t i) {
    const double exact = float64_value(result, i).value_or(0.0);
    return exact != 0.0 ? LuxValue(result.kernels[i] / exact - 1.0) : LuxValue();
}

LuxValue range_loss_value(const Illuminances& result, std::size_t i) {
    return result.range_loss[i];
}

LuxValue environment_value(const Illuminances& result, std::size_t i) {
    return result.environment[i];
}

bool has_environment(const Illuminances& result) { return !result.environment.empty(); }

// What each point has: a column of tables, a key of JSON.
struct LuxColumn {
    const char* title;
    const char* key;
    LuxValue (*value)(const Illuminances& result, std::size_t i);
    bool (*is_present)(const Illuminances& result) = nullptr;  // null: always
};

constexpr LuxColumn kLuxColumns[] = {
    {"illuminance [lx]", "illuminance_lx", illuminance_value},
    {"kernels [lx]", "kernels_lx", kernels_value},
    {"float64 [lx]", "float64_lx", float64_value},
    {"error of kernels", "relative_error_of_kernels", kernel_error},
    {"cut off at most [lx]", "cut_off_at_most_lx", range_loss_value},
    {"environment [lx]", "environment_lx", environment_value, has_environment}};

void each_column(const Illuminances& result, const auto& call) {
    for (const LuxColumn& column : kLuxColumns) {
        if (column.is_present == nullptr || column.is_present(result)) call(column);
    }
}

LuxJson lux_json(const LuxValue& value) { return value ? LuxJson(*value) : LuxJson(); }

// "17 point", or "17 point 'lamp'" with the name of its photometric file.
std::string light_name(const LitScene& lit, std::size_t index) {
    const SceneLight& light = lit.scene.lights[index];
    std::string out = fmt::format("{} {}", lit.light_numbers[index], kind_of(light).name);
    if (light.profile < 0) return out;
    const SceneProfile& profile = lit.scene.aimed_profiles[static_cast<std::size_t>(light.profile)];
    const std::string& web = lit.scene.webs[profile.web].name;
    return web.empty() ? out : fmt::format("{} '{}'", out, web);
}

struct LuxSummary {
    double least = 0.0, mean = 0.0, most = 0.0;
    double uniformity() const { return mean > 0.0 ? least / mean : 0.0; }
};

LuxSummary summary_of(const Illuminances& result) {
    LuxSummary out{std::numeric_limits<double>::infinity(), 0.0, 0.0};
    CompensatedSum sum;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        const double lux = lux_of(result, i);
        sum.add(lux);
        out.least = std::min(out.least, lux);
        out.most = std::max(out.most, lux);
    }
    out.mean = sum.value() / static_cast<double>(result.points.size());
    return out;
}

// The kernels against float64 on the points that have both.
struct KernelErrors {
    std::optional<double> relative;  // the largest, of points that both light; none: there is none
    std::optional<double> lux;       // the largest difference [lx]; none: nothing was compared
    std::size_t lit_by_one = 0;      // points that only one of both lights
};

KernelErrors errors_of(const Illuminances& result) {
    KernelErrors out;
    for (std::size_t k = 0; k < result.exact.size(); ++k) {
        const double exact = result.exact[k].lux;
        const double found = result.kernels[result.float64_indices[k]];
        out.lux = std::max(out.lux.value_or(0.0), std::abs(found - exact));
        out.lit_by_one += (found > 0.0) != (exact > 0.0);
        if (found > 0.0 && exact > 0.0) {
            out.relative = std::max(out.relative.value_or(0.0), std::abs(found / exact - 1.0));
        }
    }
    return out;
}

std::string errors_text(const KernelErrors& errors) {
    if (!errors.lux) return "kernels are not compared";
    std::string out = "kernels differ by ";
    if (errors.relative) out += fmt::format("{:.2g} relative, ", *errors.relative);
    out += fmt::format("{:.2g} lx at most", *errors.lux);
    if (errors.lit_by_one == 0) return out;
    return out + fmt::format(
                     "; only one of the two ways lights {} of these points (edges of cones, "
                     "ranges, webs, grazing light)",
                     errors.lit_by_one);
}

double largest_of(const std::vector<double>& values) {
    return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

LuxJson summary_json(const Illuminances& result, const LitScene& lit) {
    const LuxSummary lux = summary_of(result);
    const KernelErrors errors = errors_of(result);
    LuxJson out{{"points", result.points.size()},
                {"lights", lit.scene.lights.size()},
                {"minimum_lx", lux.least},
                {"mean_lx", lux.mean},
                {"maximum_lx", lux.most},
                {"uniformity", lux.uniformity()},
                {"cut_off_by_ranges_at_most_lx", largest_of(result.range_loss)},
                {"ambient_apart_lx", result.ambient},
                {"environment_apart_at_most_lx", largest_of(result.environment)}};
    out["float64"] = {{"points", result.exact.size()},
                      {"largest_relative_error_of_kernels", lux_json(errors.relative)},
                      {"largest_error_of_kernels_lx", lux_json(errors.lux)},
                      {"lit_by_one", errors.lit_by_one}};
    out["model"] = kModel;
    return out;
}

// What a light adds to a point; where it is, or shines to.
LuxJson contributor_json(const LitScene& lit, const LightLux& part) {
    const SceneLight& light = lit.scene.lights[part.light];
    const bool is_placed = kind_of(light).is_placed;
    const glm::dvec3& place = is_placed ? light.position : light.direction;
    return {{"light", lit.light_numbers[part.light]},
            {"name", light_name(lit, part.light)},
            {is_placed ? "position" : "direction", {place.x, place.y, place.z}},
            {"lux", part.lux}};
}

// Of points with a float64 value.
void add_contributors(std::vector<Cell>& row, const ExactIlluminance* exact, const LitScene& lit) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (exact != nullptr && exact->largest[k].lux > 0.0) {
            row.emplace_back(light_name(lit, exact->largest[k].light));
            row.emplace_back(exact->largest[k].lux);
        } else {
            row.resize(row.size() + 2);
        }
    }
}

std::vector<Cell> table_row(const Illuminances& result, const LitScene& lit, std::size_t i) {
    const MeasuringPoint& point = result.points[i];
    const glm::dvec3 &p = point.position, &n = point.normal;
    std::vector<Cell> row = {p.x, p.y, p.z, n.x, n.y, n.z};
    each_column(result,
                [&](const LuxColumn& column) { row.push_back(cell_of(column.value(result, i))); });
    add_contributors(row, result.exact_of(i), lit);
    return row;
}

LuxJson point_json(const Illuminances& result, const LitScene& lit, std::size_t i) {
    const MeasuringPoint& point = result.points[i];
    const glm::dvec3 &p = point.position, &n = point.normal;
    LuxJson out{{"position", {p.x, p.y, p.z}}, {"normal", {n.x, n.y, n.z}}};
    each_column(result, [&](const LuxColumn& column) {
        out[column.key] = lux_json(column.value(result, i));
    });
    const ExactIlluminance* exact = result.exact_of(i);
    out["largest"] = LuxJson::array();
    if (exact == nullptr) return out;
    for (const LightLux& part : exact->largest) {
        if (part.lux > 0.0) out["largest"].push_back(contributor_json(lit, part));
    }
    return out;
}

}  // namespace

const ExactIlluminance* Illuminances::exact_of(std::size_t i) const {
    const auto found = std::lower_bound(float64_indices.begin(), float64_indices.end(), i);
    if (found == float64_indices.end() || *found != i) return nullptr;
    return &exact[static_cast<std::size_t>(found - float64_indices.begin())];
}

Table illuminance_table(const Illuminances& result, const LitScene& lit, std::size_t first,
                        std::size_t end) {
    Table out{{"x [m]", "y [m]", "z [m]", "nx", "ny", "nz"}, {}};
    each_column(result, [&](const LuxColumn& column) { out.columns.emplace_back(column.title); });
    for (const char* place : {"1", "2", "3"}) {
        out.columns.push_back(fmt::format("light {}", place));
        out.columns.push_back(fmt::format("light {} [lx]", place));
    }
    for (std::size_t i = first; i < end; ++i) out.rows.push_back(table_row(result, lit, i));
    return out;
}

LuxJson illuminance_json(const Illuminances& result, const LitScene& lit) {
    LuxJson out{{"summary", summary_json(result, lit)}, {"points", LuxJson::array()}};
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        out["points"].push_back(point_json(result, lit, i));
    }
    return out;
}

std::string illuminance_text(const Illuminances& result, const LitScene& lit) {
    constexpr std::size_t kShown = 20;  // lines of the table
    const LuxSummary lux = summary_of(result);
    std::string out = fmt::format(
        "points      {}, {} lights; {}\n"
        "illuminance minimum {:.6g} lx, mean {:.6g} lx, maximum {:.6g} lx; uniformity (minimum / "
        "mean) {:.4g}\n"
        "float64     on {} points: {}\n"
        "ranges      cut off at most {:.4g} lx at a point\n",
        result.points.size(), lit.scene.lights.size(), kModel, lux.least, lux.mean, lux.most,
        lux.uniformity(), result.exact.size(), errors_text(errors_of(result)),
        largest_of(result.range_loss));
    if (result.ambient > 0.0) out += fmt::format("ambient     {:.6g} lx, apart\n", result.ambient);
    if (!result.environment.empty()) {
        out +=
            fmt::format("environment {:.6g} lx at most, apart\n", largest_of(result.environment));
    }
    const std::size_t shown = std::min(kShown, result.points.size());
    out += '\n';
    out += to_markdown(illuminance_table(result, lit, 0, shown), 6);
    if (shown < result.points.size()) {
        out += fmt::format("{} more points: files of -o and --json have all\n",
                           result.points.size() - shown);
    }
    return out;
}

}  // namespace kilolux
