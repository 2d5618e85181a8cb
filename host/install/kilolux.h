// SPDX-License-Identifier: Apache-2.0
// The OpenCL half of Kilolux: everything that lights a G-buffer with many lights.
//
// A program brings a cl::Context with a queue (or lets Gpu make them), a G-buffer in one cl::Buffer
// and lights in another; host/example/light_gbuffer.cpp is the whole of it:
//
//     DeferredLighting lighting(gpu, tuning, features);
//     const Radiance radiance = lighting.light({gbuffer, lights, grid}, timer);
//
// Behind it stand LightLists (BinPixels, PrepareLights, BuildClusters, CullLights, RefineLights)
// and Shade; a program may run these stages itself. A stage compiles in its constructor, its
// enqueue() does not block, and its results stay valid until its next enqueue(). What must match
// between stages is one KernelFeatures and one Tuning for all of them, and one View and ClusterGrid
// a frame.
//
// The stable part is what this header brings in: names, and the layouts of kernels/shared (rows of
// 16 bytes, checked on the device). Include it as <kilolux/kilolux.h>.
#pragma once

// IWYU pragma: begin_exports
#include "host/lighting/deferred_lighting.h"  // DeferredLighting: radiance from G-buffer and lights
#include "host/lighting/light_lists.h"        // LightLists: which lights each pixel needs
//
#include "host/base/error.h"           // Error: what every function throws
#include "host/base/gbuffer_layout.h"  // where a G-buffer's planes lie
#include "host/base/log.h"             // who hears notes and warnings
#include "host/base/make_view.h"       // a View from view and projection matrices
#include "host/base/version.h"         // KILOLUX_VERSION
#include "host/gpu/buffer.h"           // DeviceArray, GrowingBuffer, upload, download
#include "host/gpu/device.h"           // choose_device, Gpu
#include "host/gpu/features.h"         // KernelFeatures, Tuning
#include "host/gpu/flow.h"             // what passes between stages
#include "host/gpu/program.h"          // in_stage: OpenCL's errors with the stage's name
#include "host/gpu/stage_timer.h"      // times by stage
#include "host/gpu/tuning_store.h"     // the best work sizes measured on a device
#include "host/stages/bin_pixels.h"
#include "host/stages/bloom.h"
#include "host/stages/build_clusters.h"
#include "host/stages/count_lights.h"
#include "host/stages/count_pairs.h"
#include "host/stages/cull_lights.h"
#include "host/stages/decode_gbuffer.h"
#include "host/stages/prepare_lights.h"
#include "host/stages/refine_lights.h"
#include "host/stages/shade.h"
#include "host/stages/tonemap.h"
#include "kernels/shared/evaluate_modes.h"  // SHADING_*
#include "kernels/shared/gbuffer.h"         // planes, octahedral_encode
#include "kernels/shared/tone_curve.h"      // TONE_CURVE_*
// IWYU pragma: end_exports
