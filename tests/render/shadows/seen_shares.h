// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "host/certify/shadow_scenarios.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/render/settings.h"

namespace kilolux {

/// The share of a light that a pixel sees, of what it would reflect if nothing were hidden.
struct SharePixel {
    std::size_t index = 0;
    glm::dvec3 position{0.0};    // world [m]
    double truth = 0.0;          // by quadrature in double
    double diffuse_truth = 0.0;  // the same weighted by the cosine alone
    bool is_edge = false;        // a quadrature cannot tell whether the light is seen in part
    double mean = 0.0;           // of pictures with seeds 1, 2, ...
    double variance = 0.0;       // of a picture, from their spread
    double estimated = 0.0;      // mean of the variances by --aov error-standard
    int batches_within = 0;      // whose estimated 95 % interval holds the truth
};

struct SharePixels {
    std::vector<SharePixel> pixels;  // that the light reaches
    int pictures = 0, batches = 0;
};

/// Measures a scenario's only light with `pictures` pictures, in batches of `batch`.
SharePixels seen_shares(const ShadowScenario& scenario, RenderSettings settings, int pictures,
                        int batch = 20);

glm::dvec3 world_of(const Camera& camera, const glm::dvec3& p_view);

}  // namespace kilolux
