// SPDX-License-Identifier: Apache-2.0
// Parts of lights with a size, and the reference of their shadows.
#include "host/measure/reference/area/area_parts.h"

#include <gtest/gtest.h>

#include "tests/measure/area/area_cases.h"

namespace kilolux {
namespace {

// Their solid angles and cosines are those of the integrals.
TEST(AreaParts, SumToTheIntegral) {
    AreaRandom random(11);
    for (const AreaKind kind :
         {AreaKind::rectangle, AreaKind::disk, AreaKind::sphere, AreaKind::triangle}) {
        for (int i = 0; i < 20; ++i) {
            const AreaShape shape = random_shape(kind, random.log_uniform(2.0, 20.0), 1.0, random);
            double sum = 0.0;
            for (const AreaPart& part : parts_of(shape, 64)) {
                sum += part.solid_angle * std::max(0.0, glm::normalize(part.to_light).z);
            }
            const AreaCosine exact = reference_cosine(shape, {0, 0, 1});
            EXPECT_NEAR(sum, exact.value, 0.01 * exact.value + 1e-4) << shape;
        }
    }
}

}  // namespace
}  // namespace kilolux
