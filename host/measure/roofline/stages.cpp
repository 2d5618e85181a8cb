// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/stages.h"

#include <algorithm>

#include "host/interop/gbuffer_bridge.h"
#include "host/render/forward_shading.h"
#include "host/render/frame.h"
#include "host/render/surface_pass.h"
#include "host/stages/lights/move_lights.h"
#include "host/stages/lights/prepare_lights.h"
#include "host/stages/lists/bin_pixels.h"
#include "host/stages/lists/build_clusters.h"
#include "host/stages/lists/count_lights.h"
#include "host/stages/lists/count_pairs.h"
#include "host/stages/lists/cull_lights.h"
#include "host/stages/lists/mask_tiles.h"
#include "host/stages/lists/refine_lights.h"
#include "host/stages/picture/adaptive_samples.h"
#include "host/stages/picture/bloom.h"
#include "host/stages/picture/pack_radiance.h"
#include "host/stages/picture/sum_samples.h"
#include "host/stages/picture/tonemap.h"
#include "host/stages/shading/fill_background.h"
#include "host/stages/shading/reflect_environment.h"
#include "host/stages/shading/shade.h"
#include "host/stages/shadows/cast_shadows.h"
#include "host/stages/shadows/count_seen.h"
#include "host/stages/shadows/draw_shadows.h"
#include "host/stages/shadows/shadow_origins.h"
#include "host/stages/surfaces/bin_triangles.h"
#include "host/stages/surfaces/blend_layer.h"
#include "host/stages/surfaces/build_mips.h"
#include "host/stages/surfaces/count_texels.h"
#include "host/stages/surfaces/decode_gbuffer.h"
#include "host/stages/surfaces/raster_layers.h"
#include "host/stages/surfaces/raster_triangles.h"
#include "host/stages/surfaces/repack_gbuffer.h"
#include "host/stages/surfaces/resolve_surfaces.h"
#include "host/stages/tails/cut_light_tree.h"
#include "host/stages/tails/tail_errors.h"

namespace kilolux {
namespace {

constexpr const StageInfo* kStages[] = {&kLightInputStage,     &kGeometryStage,
                                        &kGBufferBridgeStage,  &kMoveLightsStage,
                                        &kBinTrianglesStage,   &kRasterTrianglesStage,
                                        &kMaskTilesStage,      &kResolveSurfacesStage,
                                        &kPrepareLightsStage,  &kBuildClustersStage,
                                        &kCullLightsStage,     &kBinPixelsStage,
                                        &kRefineLightsStage,   &kCutLightTreeStage,
                                        &kCountPairsStage,     &kShadowSceneStage,
                                        &kShadowOriginsStage,  &kDrawShadowsStage,
                                        &kCastShadowsStage,    &kShadeStage,
                                        &kForwardStage,        &kForwardPlusStage,
                                        &kRasterLayersStage,   &kBlendLayerStage,
                                        &kFillBackgroundStage, &kReflectEnvironmentStage,
                                        &kBloomStage,          &kTailErrorsStage,
                                        &kSumSamplesStage,     &kAdaptiveSamplesStage,
                                        &kTonemapStage,        &kReadBackStage,
                                        &kLaunchStage,         &kEnqueueStage,
                                        &kAllocateStage,       &kBuildMipsStage,
                                        &kDecodeGbufferStage,  &kCountTexelsStage,
                                        &kCountLightsStage,    &kCountSeenStage,
                                        &kRepackGbufferStage,  &kPackRadianceStage};

}  // namespace

std::span<const StageInfo* const> all_stages() { return kStages; }

const StageInfo* stage_info(std::string_view name) {
    const auto found = std::ranges::find(kStages, name, [](const StageInfo* s) { return s->name; });
    return found == std::end(kStages) ? nullptr : *found;
}

StageGroup group_of(std::string_view stage) {
    const StageInfo* info = stage_info(stage);
    return info ? info->group : StageGroup::host;
}

}  // namespace kilolux
