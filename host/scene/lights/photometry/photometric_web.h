// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kilolux {

/// The intensity of a luminaire by direction: photometry of type C (IES LM-63, CIE 121). Vertical
/// angle 0 is its direction, horizontal angles turn about that axis.
struct PhotometricWeb {
    std::string name;                // of the file's light
    std::string text;                // LM-63 text, for export
    std::vector<double> vertical;    // [deg] rising, within 0 to 180; two or more
    std::vector<double> horizontal;  // [deg] 0 alone: the same all around; else rising, 0 to 360
    std::vector<double> candela;     // [horizontal][vertical] >= 0 [cd]
    double peak = 0.0;               // the largest of them, > 0 [cd]
    std::vector<float> table;        // what kernels read: see kernels/shared/light_profile.h
    double table_error =
        0.0;  // the largest error of the table at the file's angles, as a share of the peak
    // What the file says of itself; none: nothing.
    std::optional<double> stated_lumens;      // LM-63: of its lamps; EULUMDAT: of the luminaire
    std::optional<double> stated_down_share;  // EULUMDAT: of the flux, below vertical angle 90
};

/// Bilinear between the file's angles; 0 beyond its vertical ones [cd]. Angles in degrees,
/// `horizontal` from 0 to 360.
double candela_at(const PhotometricWeb& web, double vertical, double horizontal);

/// Flux up to a vertical angle [deg], integrated over candela_at() in closed form [lm]: each cell
/// of the file's angles is bilinear in them, so the error is that of rounding.
double lumens(const PhotometricWeb& web, double up_to = 180.0);

/// An IES file of type C (LM-63-2002) that is read as this web, bit for bit.
std::string lm63_text(const PhotometricWeb& web);

/// Makes the table for kernels, with steps of which all of the file's angles are multiples, or the
/// smallest allowed. Sets table_error.
void make_profile_table(PhotometricWeb& web);

/// Where each web's table starts in all of them, one after the other. Throws Error where they are
/// more than kernels can number.
std::vector<float> profile_starts(std::span<const PhotometricWeb> webs);

}  // namespace kilolux
