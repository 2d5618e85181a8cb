// SPDX-License-Identifier: Apache-2.0
// The rows of visit_settings() about the picture's content and look.
#include "present/cli/picture_settings.h"

#include <fmt/format.h>
#include <tuple>

#include "host/picture/views.h"
#include "present/cli/option_builder.h"

namespace kilolux {
namespace {

// The renderer's views, and the comparison's.
Choices show_choices() {
    Choices choices = choices_of(ViewKind{});
    choices.names.emplace_back("error");
    choices.meanings.emplace_back("heat map of the relative error to --reference (render only)");
    return choices;
}

void take_samples(SharedOptions& o, const std::string& name, const std::string& text) {
    RenderSettings& s = o.settings;
    refuse_if(text == "auto" && !o.takes_automatic_samples,
              name + ": only render makes it automatic");
    const std::uint64_t count = parse_count(name, text, kSamplesRange, o.takes_automatic_samples);
    s.auto_samples.on = count == 0;
    if (count > 0) s.samples = static_cast<int>(count);
}

void visit_picture(const SettingVisitor& f, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto resolution = [&s](const std::string& name, const std::string& text) {
        std::tie(s.width, s.height) = parse_resolution(name, text);
    };
    const bool automatic = o.takes_automatic_samples;
    OptionBuilder(f, "Picture")
        .choice({"--renderer", "", "", "How surfaces are lit", kPanelPicture}, s.renderer)
        .value(SettingKind::numbers,
               {"--resolution", "W,H", "", "Size; WxH is as good", kPicture, "px"}, resolution,
               [&s] { return fmt::format("{},{}", s.width, s.height); })
        .value(
            SettingKind::count,
            {"--samples", automatic ? "N|auto" : "N", "",
             automatic ? "Jittered samples a pixel; auto: as many as each tile of 16x16 pixels "
                         "needs, see --sample-error"
                       : "Jittered samples a pixel",
             kPanelPicture, "1"},
            [&o](const auto& name, const auto& text) { take_samples(o, name, text); },
            [&s] { return s.auto_samples.on ? "auto" : text_of(s.samples); })
        .number({"--time", "T", "", "Moves the lights and the file's animations", kPicture, "s"},
                o.time)
        .choice(
            {"--show", "", "", "What the picture shows", kPanelPicture}, show_choices(),
            [&o](std::size_t place) {
                o.show_error = place == view_names().size();
                o.settings.want.view = o.show_error ? ViewKind::lit : static_cast<ViewKind>(place);
            },
            [&o] { return o.show_error ? "error" : name_of(o.settings.want.view); })
        .choice_list({"--aov", "", "none", "Layers of an EXR file beside its colour", kPicture},
                     s.want.aovs, aov_choices())
        .value({"--light-groups", "NAME=PATTERN,...|each", "none",
                "Layers light.NAME of an EXR file: the light of each group of lights and of the "
                "rest, whose sum is the picture. Patterns are joined by +, a light is in the first "
                "group that matches; " +
                    light_pattern_meaning() + "; each: a group for each node with lights",
                kPicture},
               o.light_groups, parse_light_groups)
        .value({"--light-mix", "NAME=GAIN[:COLOR],...", "none",
                "Multiplies the light of groups of --light-groups, or of the rest, by a gain of at "
                "least 0 and a colour: R,G,B (linear) or #RRGGBB (sRGB)",
                kPicture},
               s.light_mix.gains, parse_light_mix)
        .flag("--no-light-layers", o.no_light_layers,
              "No layers of --light-groups: they serve --light-mix only, and cost nothing",
              kPicture)
        .choice({"--aov-layer", "", "", "Of which surfaces --aov and --show tell", kPicture},
                s.want.layer);
}

void visit_surfaces(const SettingVisitor& f, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto take_ambient = [&o](const std::string& name, const std::string& text) {
        o.settings.ambient = static_cast<float>(parse_number(name, text, kAmbientRange));
        o.ambient_given = true;
    };
    const auto take_rays = [&o](const std::string& name, const std::string& text) {
        o.settings.shadow_rays = static_cast<int>(parse_count(name, text, kShadowRaysRange));
        o.shadow_rays_given = true;
    };
    OptionBuilder(f, "Picture")
        .rest()
        .choice({"--gbuffer", "", "", "How a pixel is stored between the passes", kPanelPicture},
                s.gbuffer, gbuffer_choices())
        .choice({"--geometry", "", "", "How surfaces get into the G-buffer", kPicture}, s.geometry)
        .value(
            {"--anisotropy", "N", "1 on CPUs, 8 on GPUs", "Texture samples along a footprint",
             kPicture, "1"},
            s.anisotropy,
            [](const auto& name, const auto& text) {
                return parse_count(name, text, kAnisotropyRange);
            },
            [&s] { return s.anisotropy == 0 ? "" : text_of(s.anisotropy); })
        .number({"--sample-error", "E", "",
                 "With --samples auto: a tile stops at this relative standard error of its "
                 "luminance; dark light counts as 0.1 of white at least",
                 kPicture, "1"},
                s.auto_samples.error, kAboveZeroRange)
        .count(
            {"--max-samples", "N", "", "With --samples auto: most samples a pixel", kPicture, "1"},
            s.auto_samples.most, kAutoSamplesRange)
        .flag("--no-reuse", s.no_reuse, "Compute every frame anew, also what has not changed",
              kTime)
        .choice({"--shading", "", "", "How surfaces reflect light", kPanelPicture}, s.shading)
        .choice({"--shadows", "", "", "Which lights a surface sees", kPanelPicture}, s.shadows)
        .flag("--opaque-shadows", s.opaque_shadows,
              "Exact shadows of opaque surfaces only: not the tinted ones of glass", kPicture)
        .value(SettingKind::count,
               {"--shadow-rays", "N",
                text_of(s.shadow_rays) + "; with --max-error as many as it takes",
                "Rays a pixel of sampled shadows, at most on average", kPicture, "1"},
               take_rays, [&s] { return text_of(s.shadow_rays); })
        .count({"--seed", "N", "", "Random numbers of sampled shadows and stochastic tails",
                kPicture, "1"},
               s.seed, kSeedRange)
        .value(SettingKind::number,
               {"--ambient", "L",
                text_of(s.ambient) + "; with the rig studio " +
                    text_of(rig_ambient(Rig::studio, s.ambient)),
                "Radiance from everywhere, times the albedo", kPanelPicture, "cd/m2"},
               take_ambient, [&s] { return text_of(s.ambient); });
}

// The curves, and Khronos PBR Neutral by its whole name.
Choices tone_curve_choices() {
    Choices choices = choices_of(ToneCurve{});
    choices.names.emplace_back("pbr-neutral");
    choices.meanings.emplace_back("the same as neutral");
    return choices;
}

void take_exposure(SharedOptions& o, const std::string& name, const std::string& text) {
    o.automatic_exposure = text == "auto";
    refuse_if(o.automatic_exposure && !o.takes_automatic_exposure,
              name + ": only render makes it automatic");
    o.settings.exposure =
        static_cast<float>(parse_number(name, text, kExposureRange, o.takes_automatic_exposure));
}

void visit_display(const SettingVisitor& f, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto take_curve = [&o, &s](std::size_t place) {
        o.tone_curve_given = true;
        const bool whole_name = place == names_of<ToneCurve>().size();
        s.tone_curve = whole_name ? ToneCurve::neutral : static_cast<ToneCurve>(place);
    };
    const auto take_background = [&o](const std::string& name, const std::string& text) {
        refuse_if(!o.shows_environment && text != "auto", name + ": only render and view show it");
        return parse_background(name, text);
    };
    const bool automatic = o.takes_automatic_exposure;
    OptionBuilder(f, "Display (PNG, JPEG, TIFF; EXR and HDR stay linear and unclamped)")
        .value(
            SettingKind::number,
            {"--exposure", automatic ? "EV|auto" : "EV", "",
             automatic ? "Each step doubles the brightness; auto: the log average of the picture's "
                         "luminance becomes 0.18, or less where more than 2 % would clip; a "
                         "sequence keeps that of its first frame"
                       : "Each step doubles the brightness",
             kPanelPicture, "EV"},
            [&o](const auto& name, const auto& text) { take_exposure(o, name, text); },
            [&o] { return o.automatic_exposure ? "auto" : text_of(o.settings.exposure); })
        .choice({"--tonemap", "", name_of(s.tone_curve) + "; of an unlit scene none",
                 "Curve from scene light to the display's range", kPanelPicture},
                tone_curve_choices(), take_curve, [&s] { return name_of(s.tone_curve); })
        .value({"--background", "COLOUR|none|auto", "",
                "What is behind the scene: #RRGGBB, as the display shows it without bloom; R,G,B: "
                "linear light that exposure and tone curve apply to; none: black, and clear in PNG "
                "and "
                "EXR without bloom; auto: the environment, else black",
                kPicture},
               o.background, take_background)
        .number({"--bloom", "K", "", "Share of the light that blooms, 0 to 1", kPanelPicture, "1"},
                s.bloom, kBloomRange);
}

}  // namespace

void visit_picture_settings(SharedOptions& options, const SettingVisitor& f) {
    visit_picture(f, options);
    visit_surfaces(f, options);
    visit_display(f, options);
}

}  // namespace kilolux
