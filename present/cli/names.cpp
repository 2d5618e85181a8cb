// SPDX-License-Identifier: Apache-2.0
#include "present/cli/names.h"

#include <fmt/format.h>

#include "host/base/formats/gbuffer_layout.h"
#include "host/measure/bench/sweep.h"
#include "host/measure/metrics/error_metrics.h"
#include "host/picture/aovs.h"
#include "host/picture/views.h"

namespace kilolux {
Choices::Choices(std::initializer_list<std::pair<std::string, std::string>> described) {
    for (const auto& [name, meaning] : described) {
        names.push_back(name);
        meanings.push_back(meaning);
    }
}

const Choices& choices_of(RendererKind) {
    static const Choices choices = {
        {renderer_name(RendererKind::deferred),
         "clustered deferred: only lights that may reach a pixel are evaluated"},
        {renderer_name(RendererKind::forward_plus), "clustered forward"},
        {renderer_name(RendererKind::forward), "every light at every fragment: a reference"},
        {renderer_name(RendererKind::deferred_all),
         "every light at every pixel: the reference for deferred"}};
    return choices;
}

const Choices& choices_of(Geometry) {
    static const Choices choices = {
        {"auto",
         "compute where it was measured faster on such a device, or without OpenGL; else ids"},
        {"ids", "OpenGL draws triangle ids, OpenCL makes the surfaces"},
        {"compute", "OpenCL draws them, too: no OpenGL, the same ids on every device"},
        {"planes", "OpenGL's fragments write the surfaces"}};
    return choices;
}

const Choices& choices_of(BenchMotion) {
    static const Choices choices = {
        {"camera", "camera and lights move a little: nothing can be kept of the last frame"},
        {"lights", "the camera stands: surfaces are kept"},
        {"none", "nothing moves"}};
    return choices;
}

const Choices& choices_of(Shading) {
    static const Choices choices = {
        {"auto", "pbr; lambert where nothing is lit"},
        {"lambert", "matt: albedo / pi"},
        {"blinn-phong", "with normalised highlights"},
        {"pbr", "glTF's metallic-roughness model"},
        {"illuminance", "what surfaces receive of lights [lx], not what they reflect"}};
    return choices;
}

const Choices& choices_of(Shadows) {
    static const Choices choices = {
        {"off", "every light is seen"},
        {"exact", "a ray for each light of a pixel's list, against all triangles"},
        {"sampled", "the same in the mean, by --shadow-rays a pixel"}};
    return choices;
}

const Choices& choices_of(Tails) {
    static const Choices choices = {
        {"auto",
         fmt::format(
             "exact for at most {} such lights and no --range-budget, else bounded; "
             "where that would lose a tenth of the light at a point, tree, or where no tree can be "
             "(shadows, blended surfaces, forward renderers, bench) bounded with longer ranges",
             kExactTails)},
        {"exact", "they reach every pixel"},
        {"bounded", "each ends where --range-budget says"},
        {"stochastic", "random ranges, at least that of bounded: right in the mean of --samples"},
        {"tree", "they reach every pixel, far ones in groups that err by --tree-share at most"}};
    return choices;
}

const Choices& choices_of(ToneCurve) {
    static const Choices choices = {
        {"none", "clamp at 1"},
        {"neutral", "Khronos PBR Neutral: up to 0.04 less, above 0.8 compressed"},
        {"aces", "ACES, filmic contrast"},
        {"agx", "AgX, bright colours go to white softly"}};
    return choices;
}

const Choices& choices_of(Rig) {
    static const Choices choices = {
        {"auto",
         "swarm where lights are asked for, none for scenes with lights, swarm for other "
         "generated ones and interiors, else studio; bench and report: swarm"},
        {"none", "only the file's own lights"},
        {"swarm", "moving coloured point lights, as many as --lights says"},
        {"studio", "key, fill and rim light in a soft surround"},
        {"headlight", "one light that shines as the camera looks"}};
    return choices;
}

const Choices& choices_of(EmissiveLights) {
    static const Choices choices = {
        {"auto",
         "on where the scene would have no other light and shading and shadows take lights with a "
         "size; else off, for files often have lamps and lights that stand for them"},
        {"on", "beside all other lights; not with blinn-phong and exact shadows"},
        {"off", "they only are seen"}};
    return choices;
}

const Choices& choices_of(Fit) {
    static const Choices choices = {{"height", "its vertical field"},
                                    {"width", "its horizontal field"},
                                    {"both", "all that it shows"}};
    return choices;
}

const Choices& choices_of(SeenFrom) {
    static const Choices choices = {
        {"auto", "inside where walls without outer sides enclose a point within, else outside"},
        {"inside", "as an interior, with a swarm's lights"},
        {"outside", "as an object, whole, with a studio's lights"}};
    return choices;
}

const Choices& choices_of(ProgressKind) {
    static const Choices choices = {
        {"auto", "a bar on a terminal, else plain"},
        {"plain", "a line on stderr every 10 s"},
        {"openjd", "\"openjd_progress: 41.5\" on stdout, for Open Job Description"},
        {"alf", "\"ALF_PROGRESS 41%\" on stdout, for Tractor and others"},
        {"none", "nothing; auto with --quiet"}};
    return choices;
}

const Choices& choices_of(MathMode) {
    static const Choices choices = {{"exact", "as OpenCL C demands"},
                                    {"fast-relaxed", "with -cl-fast-relaxed-math"},
                                    {"native", "with native square roots and reciprocals"}};
    return choices;
}

const Choices& choices_of(LightColors) {
    static const Choices choices = {{"float", "32 bits a channel"}, {"half", "16 bits a channel"}};
    return choices;
}

const Choices& choices_of(SurfaceLayer) {
    static const Choices choices = {
        {"opaque", "the opaque ones, behind those that blend or transmit light"},
        {"nearest", "the nearest ones; numbers of lights remain those of the opaque ones"}};
    return choices;
}

Choices gbuffer_choices() {
    return {{gbuffer_layout_name(GBUFFER_PACKED), "12 bytes a pixel, more where materials need it"},
            {gbuffer_layout_name(GBUFFER_FULL), "32-bit floats"},
            {gbuffer_layout_name(GBUFFER_HALF), "16-bit floats for position and normal"},
            {gbuffer_layout_name(GBUFFER_NORMAL_XY), "two components of the normal"},
            {gbuffer_layout_name(GBUFFER_OCT_2X4), "octahedral normal, two rows of four floats"}};
}

Choices aov_choices() {
    Choices out(std::vector<std::string>{});
    for (const AovKind& kind : aov_kinds()) {
        out.names.push_back(kind.name);
        out.meanings.push_back(kind.meaning);
    }
    return out;
}

Choices metric_choices() {
    Choices out(std::vector<std::string>{});
    for (const ErrorMetric& m : error_metrics()) {
        if (!m.is_error || m.part == MetricPart::display) continue;
        out.names.emplace_back(m.name);
        out.meanings.emplace_back(m.meaning);
    }
    return out;
}

const Choices& choices_of(ViewKind) {
    static const Choices choices = [] {
        Choices out(view_names());
        out.meanings = view_meanings();
        return out;
    }();
    return choices;
}

}  // namespace kilolux
