// SPDX-License-Identifier: Apache-2.0
#include "host/scene/enclosure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "host/scene/look_around.h"

namespace kilolux {
namespace {

using Hit = LookAround::Hit;
using Side = LookAround::Side;

constexpr double kEnclosedShare = 0.5;       // of the rays from within: hit front faces
constexpr double kClosedShare = 0.5;         // of the rays from the middle: hit back faces
constexpr double kOutsideShare = 1.0 / 3.0;  // of the view of front faces: outside
constexpr double kBacksShare = 0.25;         // of the view from outside: backs of walls
constexpr double kRoomShare = 0.25;          // of the box: seen from within
constexpr double kRoomOpenShare = 0.4;       // of the view of reached faces: outside
constexpr double kSealedShare = 0.995;       // of the rays from within: hit front faces
constexpr double kSealedRoomShare = 0.1;     // of the box: gaps between bricks are narrower
constexpr double kSealedOpenShare = 0.6;     // of the view of reached faces: outside
constexpr std::size_t kInnerRays = 1024;     // from a point
constexpr std::size_t kLineWays = 64;        // directions of lines through the scene
constexpr std::size_t kReachLineWays = 8;    // of those from whose surfaces walks start
constexpr int kLines = 10;                   // of each direction, along the edge of a square
constexpr int kMostHits = 100;               // of a line
constexpr int kWalkSteps = 16;               // of a walk
constexpr double kLift = 1e-5;               // of the diagonal: a walk's start off its surface
constexpr double kFloor = 0.5;               // cosine to +Y of ground, whose backs say nothing

// Points of a Fibonacci lattice on the unit sphere.
std::vector<glm::dvec3> directions(std::size_t count) {
    std::vector<glm::dvec3> out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<double>(i);
        const double y = 1.0 - (2.0 * at + 1.0) / static_cast<double>(count);
        const double turn = 2.0 * std::numbers::pi * std::fmod(at / std::numbers::phi, 1.0);
        const double radius = std::sqrt(1.0 - y * y);
        out.emplace_back(radius * std::cos(turn), y, radius * std::sin(turn));
    }
    return out;
}

// The middle of a box, and points beside it, since an object may stand in the middle of a room.
std::vector<glm::dvec3> inner_points(const Box& box) {
    const glm::dvec3 step = 0.25 * box.size();
    const glm::dvec3 c = box.center();
    return {c, c + glm::dvec3(step.x, 0, 0), c - glm::dvec3(step.x, 0, 0),
            c + glm::dvec3(0, 0, step.z), c - glm::dvec3(0, 0, step.z)};
}

// What a point sees, as shares.
struct Seen {
    double fronts = 0.0, backs = 0.0;
    double room = 0.0;  // of the box
};

Seen seen_from(const LookAround& around, const Box& box, const glm::dvec3& eye) {
    Seen out;
    const glm::dvec3 size = box.size();
    const double volume = size.x * size.y * size.z;
    for (const glm::dvec3& way : directions(kInnerRays)) {
        const Hit hit = around.first_hit(eye, way);
        out.fronts += hit.side == Side::front;
        out.backs += hit.side == Side::back;
        const double length = std::min(double{hit.distance}, way_out(box, eye, way));
        if (volume > 0.0)
            out.room += 4.0 / 3.0 * std::numbers::pi * length * length * length / volume;
    }
    for (double* share : {&out.fronts, &out.backs, &out.room}) *share /= double{kInnerRays};
    return out;
}

// Visits the surfaces on lines of a grid across the scene's sphere, which meet each part of a
// surface in proportion to its area, from all sides alike: `visit(start, way, hit, number)`.
template <typename Visit>
void each_on_lines(const LookAround& around, const Box& box, std::size_t ways, const Visit& visit) {
    const double radius = 0.5 * glm::length(box.size());
    const auto place = [&](int i) { return radius * ((2.0 * i + 1.0) / kLines - 1.0); };
    for (const glm::dvec3& way : directions(ways)) {
        const glm::dvec3 right = glm::normalize(glm::cross(
            way, glm::dvec3(std::abs(way.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0))));
        const glm::dvec3 up = glm::cross(right, way);
        for (int i = 0; i < kLines * kLines; ++i) {
            const glm::dvec3 start = box.center() - 2.0 * radius * way + place(i % kLines) * right +
                                     place(i / kLines) * up;
            Hit hit = around.first_hit(start, way);
            for (int n = 0; n < kMostHits && hit.side != Side::none; ++n) {
                visit(start, way, hit, n);
                hit = around.first_hit(start, way, hit.distance);
            }
        }
    }
}

// A front face that is first on its line is seen from outside.
struct Lines {
    std::size_t fronts = 0, first_fronts = 0, first_hits = 0, first_backs = 0;
};

Lines lines_through(const LookAround& around, const Box& box) {
    Lines out;
    each_on_lines(around, box, kLineWays,
                  [&](const glm::dvec3&, const glm::dvec3&, const Hit& hit, int number) {
                      const bool first = number == 0, front = hit.side == Side::front;
                      out.fronts += front;
                      out.first_hits += first;
                      out.first_fronts += first && front;
                      out.first_backs += first && !front && hit.normal.y < kFloor;
                  });
    return out;
}

double share(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Whether light that leaves a point of a surface comes, by diffuse reflections, to where an eye
// sees it.
class Walks {
 public:
    Walks(const LookAround& around, std::vector<glm::dvec3> eyes, double diagonal)
        : around_(around), eyes_(std::move(eyes)), lift_(kLift * diagonal) {}

    bool reach_an_eye(glm::dvec3 place, glm::dvec3 normal) {
        for (int step = 0; step < kWalkSteps; ++step) {
            place += lift_ * normal;
            if (is_seen(place)) return true;
            const glm::dvec3 way = glm::normalize(normal + 0.999 * ways_[random_() % ways_.size()]);
            const Hit hit = around_.first_hit(place, way);
            if (hit.side == Side::none) return false;
            place += double{hit.distance} * way;
            normal = hit.side == Side::front ? hit.normal : -hit.normal;
        }
        return false;
    }

 private:
    bool is_seen(const glm::dvec3& place) const {
        return std::ranges::any_of(eyes_, [&](const glm::dvec3& eye) {
            const double distance = glm::length(eye - place);
            return distance == 0.0 ||
                   around_.first_hit(place, (eye - place) / distance).distance >= distance;
        });
    }

    const LookAround& around_;
    std::vector<glm::dvec3> eyes_;
    double lift_;  // [m]
    std::vector<glm::dvec3> ways_ = directions(kInnerRays);
    std::minstd_rand random_{};
};

// The share of the view of front faces that is outside, without faces that the eyes' surroundings
// do not reach either.
double reached_open_share(const LookAround& around, const Box& box, std::vector<glm::dvec3> eyes) {
    Walks walks(around, std::move(eyes), glm::length(box.size()));
    std::size_t outer = 0, inner = 0;
    each_on_lines(around, box, kReachLineWays,
                  [&](const glm::dvec3& start, const glm::dvec3& way, const Hit& hit, int number) {
                      if (hit.side != Side::front) return;
                      const glm::dvec3 place = start + double{hit.distance} * way;
                      if (number == 0) ++outer;
                      if (number > 0) inner += walks.reach_an_eye(place, hit.normal);
                  });
    return share(outer, outer + inner);
}

// Measures what tells a room from a gap between objects, and says why it is one or none.
void judge_room(const LookAround& around, const Box& box, std::vector<glm::dvec3> eyes,
                Enclosure& out) {
    const bool sealed = out.within >= kSealedShare;
    const double least_room = sealed ? kSealedRoomShare : kRoomShare;
    const double most_open = sealed ? kSealedOpenShare : kRoomOpenShare;
    if (out.backs >= kBacksShare) {
        out.kind = SceneKind::interior;
        out.reason = fmt::format("{:.0f} % of what it shows outside are backs of its walls",
                                 100.0 * out.backs);
        return;
    }
    out.reason = fmt::format("a point within sees {:.0f} % of its box", 100.0 * out.room);
    if (out.room < least_room) return;
    out.reached = reached_open_share(around, box, std::move(eyes));
    if (out.reached < most_open) out.kind = SceneKind::interior;
    out.reason += fmt::format(
        ", and {:.0f} % of the surface that light from there or from outside meets is outside",
        100.0 * out.reached);
}

}  // namespace

Enclosure enclosure_of(const Scene& scene, const Box& box) {
    Enclosure out;
    if (box.empty()) {
        out.reason = "it has no surface";
        return out;
    }
    const LookAround around(scene, box);
    std::vector<glm::dvec3> eyes;
    for (const glm::dvec3& point : inner_points(box)) {
        const Seen seen = seen_from(around, box, point);
        out.within = std::max(out.within, seen.fronts);
        if (point == box.center() && seen.backs >= kClosedShare) out.kind = SceneKind::closed;
        if (seen.fronts < kEnclosedShare) continue;
        eyes.push_back(point);
        out.room = std::max(out.room, seen.room);
    }
    const Lines lines = lines_through(around, box);
    out.open = share(lines.first_fronts, lines.fronts);
    out.backs = share(lines.first_backs, lines.first_hits);
    if (eyes.empty()) {
        out.reason =
            fmt::format("surfaces face {:.0f} % of what a point within sees", 100.0 * out.within);
    } else if (out.open >= kOutsideShare) {
        out.reason = fmt::format("{:.0f} % of what its surfaces face is outside", 100.0 * out.open);
    } else {
        judge_room(around, box, std::move(eyes), out);
    }
    return out;
}

}  // namespace kilolux
