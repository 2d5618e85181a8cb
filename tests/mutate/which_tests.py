# SPDX-License-Identifier: Apache-2.0
"""Which tests may kill a mutant of a file: programs and cases, the quick ones first."""
import re

LIGHTING = [("opencl_tests", "Evaluate.*:EveryKernel.*"), ("opencl_tests", "Shade.*"), ("raster_tests", "ForwardPassTest.*"),
            ("measure_tests", "Reference.*:ReferenceLights.*"), ("render_tests", "Specular.*:Unlit.*:MathModes.*")]
BACKGROUND = [("opencl_tests", "FillBackground.*"), ("measure_tests", "Reflections.*"),
              ("render_tests", "Background.*:Reflections.*")]
DISPLAY = [("opencl_tests", "Tonemap.*"), ("render_tests", "ShadedDisplay.*:Bloom.*")]
GBUFFER = [("opencl_tests", "DecodeGBuffer.*:RepackGBuffer.*"), ("opencl_tests", "ResolveSurfaces.*"),
           ("raster_tests", "GBufferLayoutsTest.*:GeometryPassTest.*")]
SURFACES = [("opencl_tests", "ResolveSurfaces.*:CountTexels.*:EveryKernel.Triangles:EveryKernel.Surfaces"),
            ("measure_tests", "HitSurface.*:ResolvedSurfaces.*:TextureSampler.*"),
            ("raster_tests", "MaterialTest.*:SamplerTest.*:AnisotropyTest.*:GeometryPassTest.*")]
TRIANGLES = [("opencl_tests", "ExactSign.*:RasterSetUp.*:ResolveSurfaces.*:EveryKernel.Triangles"),
             ("certify_tests", "EdgeOnTriangles.*:ObliqueNearPlane.*:CoincidentTriangles.*:TriangleIds.*"),
             ("render_tests", "TriangleRoom.*:DiscreteDevice.*")]
LISTS = [("opencl_tests", "ClusterGrid.*:BuildClusters.*:Slice.*:MakeView.*:RefineLights.*:CountPairs.*:PrefixSum.*"),
         ("opencl_tests", "LightLists.*:CountLights.*:MaskTiles.*:BinPixels.*"), ("opencl_tests", "CullLights.*")]
LIGHTS = [("opencl_tests", "PrepareLights.*:MoveLights.*:DriftLights.*"), ("render_tests", "LightOrder.*:Samples.*")]
PROFILES = [("measure_tests", "LightProfile.*"), ("render_tests", "LightProfiles.*")]
AREA = [("measure_tests", "Area*.*:Ggx*.*:SampleShape.*"), ("render_tests", "AreaLights.*:Soft*.*")]
TREE = [("opencl_tests", "LightTreeKernels.*"), ("render_tests", "LightTreePictures.*")]
TAILS = [("render_tests", "Tails.*")]
BLOOM = [("render_tests", "Bloom.*")]
SAMPLES = [("opencl_tests", "AdaptiveSamples.*"), ("render_tests", "SamplePattern.*:Samples.*:AutoSamples.*")]
SHADOWS = [("opencl_tests", "ShadowTriangle.*:ShadowShaft.*:Twofold.*:CountSeen.*:CastShadows.*"), ("render_tests", "Shadows.*:SampledShadows.*:ShadowError.*")]
PICTURES = [("certify_tests", "All/HardCases.*Lanes16"), ("render_tests", "Paths.*:Bands.*:Views.*")]

# The first that fits a path below kernels/.
STEPS = (
    (r"shared/(evaluate|surface\.|evaluate_modes|power|lobes/)", LIGHTING + TAILS + PROFILES),
    (r"shared/(gbuffer|store|pack)", GBUFFER + PICTURES),
    (r"shared/(texture|mips|surface_of|material|triangle)", SURFACES + PICTURES),
    (r"shared/surface_scene", SURFACES + TRIANGLES + PICTURES),
    (r"shared/(hash|lights/light_(drift|order|transform)|light\.)", LIGHTS + LIGHTING + TAILS),
    (r"shared/light_profile", PROFILES),
    (r"shared/(area/|angle|light_extras)", AREA + PROFILES),
    (r"shared/lights/light_tree", TREE),
    (r"shared/shadow", SHADOWS),
    (r"shared/(tone_curve|srgb_code)", DISPLAY + BACKGROUND),
    (r"shared/(types|view|clusters|cluster_grid)", LISTS + LIGHTING + SURFACES + PICTURES),
    (r"shading/(environment|reflect_environment|fill_background)", BACKGROUND),
    (r"shading/(light_set|seen_lights|hidden_lights|add_light|sum_lights)", LIGHTING + SHADOWS),
    (r"shading/light_target", LIGHTING + DISPLAY),
    (r"shading/", LIGHTING + PICTURES + SHADOWS),
    (r"lights/", LIGHTS + PROFILES + TAILS),
    (r"lists/", LISTS + PICTURES),
    (r"shadows/(area_|shadow_(candidates|pick|random))", [("opencl_tests", "AreaShadows.*:EveryKernel.AreaShadows*")] + SHADOWS + AREA),
    (r"shadows/", SHADOWS),
    (r"tails/(cut_light_tree|tree_)", TREE + TAILS),
    (r"tails/", TAILS + TREE),
    (r"picture/tonemap", DISPLAY),
    (r"picture/bloom", BLOOM),
    (r"picture/pack_radiance", [("opencl_tests", "RepackGBuffer.*:PackRadiance.*")]),
    (r"picture/", SAMPLES),
    (r"surfaces/(store_gbuffer|repack_gbuffer|decode_gbuffer)", GBUFFER + PICTURES),
    (r"surfaces/(count_texels|build_mips|resolve)", SURFACES + PICTURES),
    (r"surfaces/", TRIANGLES + SURFACES + PICTURES),
    (r"device/(gbuffer|pixels)", GBUFFER + LIGHTING + PICTURES),
    (r"device/(triangle|texture|longest_edge)", SURFACES + TRIANGLES + PICTURES),
    (r"device/(display|srgb|luminance)", DISPLAY + GBUFFER),
    (r"device/(radiance|stored_light|light_index)", LIGHTING + PICTURES),
    (r"device/", LISTS + LIGHTING + GBUFFER + PICTURES),
)


def steps_of(file):
    found = next(steps for pattern, steps in STEPS if re.match(pattern, file.removeprefix("kernels/")))
    return list(dict.fromkeys(found))
