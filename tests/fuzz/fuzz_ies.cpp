// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>

#include "host/base/error.h"
#include "host/scene/lights/photometry/photometric_web.h"
#include "host/scene/lights/photometry/photometry_file.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/ies_text.h"
#include "tests/support/ldt_text.h"

namespace kilolux {

bool fuzz_ies(FuzzInput input) {
    const std::string text(input.begin(), input.end());
    try {
        const PhotometricWeb web = read_photometric_web(text, "x.ies");
        if (!(web.peak > 0.0)) std::abort();
        return true;
    } catch (const Error& error) {
        const std::string message = error.what();
        if (message.starts_with("x.ies: ") && message.find('\n') == std::string::npos) return false;
        std::fprintf(stderr, "not one line of x.ies: %s\n", message.c_str());
        std::abort();
    }
}

std::vector<std::string> ies_corpus() {
    IesText tilted, round;
    tilted.head = "IESNA:LM-63-2002\nTILT=INCLUDE\n1\n2\n0 90\n1 0.5\n";
    round.horizontal = {0, 90, 180, 270, 360};
    IesText type_b{.vertical = {-90, 0, 90}, .horizontal = {0, 45, 90}};
    type_b.type = 2;
    std::vector<std::string> out = {ies_text({}), ies_text(tilted), ies_text(round),
                                    ies_text(type_b), european(ldt_text({}))};
    for (int symmetry = 0; symmetry <= 4; ++symmetry) {
        out.push_back(ldt_text({.symmetry = symmetry}));
    }
    return out;
}

}  // namespace kilolux
