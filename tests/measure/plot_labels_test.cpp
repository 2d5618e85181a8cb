// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot_script.h"

#include <gtest/gtest.h>

#include <random>

namespace kilolux {
namespace {

// The least that gnuplot needs for a label's text [pixel].
struct Text {
    double left, right, bottom, top;
    explicit Text(const PlotLabel& l)
        : left(l.x),
          right(l.x + 6.0 * static_cast<double>(l.text.size())),
          bottom(l.y - 6.0),
          top(l.y + 6.0) {}
    bool covers(const Text& o) const {
        return left < o.right && o.left < right && bottom < o.top && o.bottom < top;
    }
    bool covers(double x, double y) const { return x > left && x < right && y > bottom && y < top; }
};

std::vector<PlotLabel> points(int count, double spread, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-spread, spread);
    std::vector<PlotLabel> out;
    for (int i = 0; i < count; ++i) {
        out.push_back({.text = "setting " + std::to_string(i),
                       .point_x = 500.0 + offset(random),
                       .point_y = 400.0 + offset(random)});
    }
    return out;
}

std::vector<PlotBox> boxes(const std::vector<PlotLabel>& points) {
    std::vector<PlotBox> out;
    for (const PlotLabel& p : points) {
        out.push_back({p.point_x - 4, p.point_y - 4, p.point_x + 4, p.point_y + 4});
    }
    return out;
}

TEST(PlotLabels, CoverNeitherEachOtherNorPointsNorTheFrame) {
    const PlotArea area;
    for (const double spread : {250.0, 60.0, 5.0}) {
        const auto labels = points(20, spread, 7);
        const auto placed = placed_labels(labels, boxes(labels), area);
        EXPECT_GE(placed.size(), 19u) << spread;
        for (std::size_t i = 0; i < placed.size(); ++i) {
            const Text text(placed[i]);
            EXPECT_GE(text.left, area.left * kPlotWidth);
            EXPECT_LE(text.right, area.right * kPlotWidth);
            EXPECT_GE(text.bottom, area.bottom * kPlotHeight);
            EXPECT_LE(text.top, area.top * kPlotHeight);
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_FALSE(text.covers(Text(placed[j])))
                    << placed[i].text << " and " << placed[j].text << ", spread " << spread;
            }
            for (const PlotLabel& p : labels) EXPECT_FALSE(text.covers(p.point_x, p.point_y));
        }
    }
}

TEST(PlotLabels, StandBesideTheirPointsWhereThereIsRoom) {
    const std::vector<PlotLabel> one = {{.text = "alone", .point_x = 300.0, .point_y = 300.0}};
    const auto placed = placed_labels(one, boxes(one), {});
    ASSERT_EQ(placed.size(), 1u);
    EXPECT_FALSE(placed[0].far);
    EXPECT_EQ(placed[0].y, 300.0);
    EXPECT_GT(placed[0].x, 300.0);
    EXPECT_LT(placed[0].x, 315.0);
    const std::vector<PlotLabel> corner = {
        {.text = "at the edge", .point_x = 0.82 * kPlotWidth - 2, .point_y = 300.0}};
    EXPECT_LT(placed_labels(corner, boxes(corner), {}).at(0).x, 0.82 * kPlotWidth - 60);
}

}  // namespace
}  // namespace kilolux
