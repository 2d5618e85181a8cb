// SPDX-License-Identifier: Apache-2.0
// The OpenCL half of Kilolux: everything that lights a G-buffer with many lights. Include it as
// <kilolux/kilolux.h>; <kilolux/kilolux_c.h> is the same for C.
//
// A program brings a cl::Context with a queue (or lets Gpu make them), a G-buffer in one cl::Buffer
// and lights in another; host/example/light_gbuffer.cpp is the whole of it:
//
//     DeferredLighting lighting(gpu, known_tuning(gpu.info).tuning, features);
//     const Radiance radiance = lighting.light({gbuffer, lights, grid}, timer);
//
// Around it: make_view() takes a renderer's own matrices, RepackGBuffer its depth, normals and
// albedo from buffers or images, MoveLights its lights in the world, and PackRadiance gives RGBA
// back. Behind it stand LightLists (BinPixels, PrepareLights, BuildClusters, CullLights,
// RefineLights), Visibility with shadows, and Shade; a program may run these stages itself. A stage
// compiles in its constructor, but for kernels that few frames need, and its results stay valid
// until its next enqueue(). What must match between stages is one KernelFeatures and one Tuning for
// all of them, and one View and ClusterGrid a frame.
//
// BUFFERS. Planes have rows of View::stride elements (the width rounded up to 16) and View::height
// rows, from the top. Those that the library owns are valid until the next call of the stage that
// made them. Alignments are in bytes, from the buffer's start or a sub-buffer's; host/gpu/flow.h
// has the shapes of the lists.
//
//   what                     elements                      unit, space           align  owner
//   GBuffer::bytes           gbuffer_bytes() of planes at  kernels/shared/       256    either [1]
//                            GBufferLayout::offset_bytes   gbuffer.h
//   SourceGBuffer::depth,    [height][pitch], or an image  SourceFormat          pixel  caller
//     normal, albedo
//   LightInput::lights       Light[count]                  m, cd; world axes,    16     either [2]
//                                                          camera at 0
//   LightInput::directional  DirectionalLight[count]       lx; world axes        16     caller
//   MoveLights::stage()      WorldLight[count], host       m, cd; world          16     library
//   Radiance::planes         float[3][height][stride]      linear Rec. 709       4      library
//   PackRadiance's           [height][pitch], or an image  linear RGBA           pixel  caller
//   Tonemap's                uint[height][stride]          sRGB codes, R lowest  4      library
//
//   [1] the caller's own planes, or what RepackGBuffer made
//   [2] the caller's own rows, or what MoveLights made
//
// QUEUES AND EVENTS. The queue is in order, with profiling; Gpu refuses another. enqueue()
// blocks only for the first shadows and in a repeat. DeferredLighting::fits() waits for the counts
// of the lists: all that was enqueued before is done when it returns. Where it is false, lists or
// words of shadows lacked room: what was enqueued
// since enqueue() does not count, and all of it is enqueued again. light() does both until they
// fit. upload(), download(), MoveLights::stage() and StageTimer::take()
// block, too; MoveLights::upload() does not.
// There are no event arguments: with one queue in order, waiting for another queue's events is
// queue.enqueueBarrierWithWaitList(&events) before the call, and an event for another queue is
// queue.enqueueMarkerWithWaitList(nullptr, &event) after it.
//
// NOT HERE. Depth-stencil images: an extension that few drivers have; copy them to a buffer.
// Out-of-order queues: the stages depend on each other, one after the other. Lights without a
// range, and reading files: that is the program's work.
//
// THREADS. Objects of one Gpu and its copies: one thread at a time. Several Gpu: several threads.
//
// The stable part is what this header brings in: names, and the layouts of kernels/shared (rows of
// 16 bytes, checked on the device). Installed macros begin with KILOLUX_.
#pragma once

// IWYU pragma: begin_exports
#include "host/lighting/deferred_lighting.h"  // DeferredLighting: radiance from G-buffer and lights
#include "host/lighting/light_lists.h"        // LightLists: which lights each pixel needs
#include "host/lighting/visibility.h"         // Visibility: which of them it sees
//
#include "host/base/error.h"                   // Error: what every function throws
#include "host/base/formats/gbuffer_layout.h"  // where a G-buffer's planes lie
#include "host/base/log.h"                     // who hears notes and warnings
#include "host/base/make_view.h"               // a View from view and projection matrices
#include "host/base/version.h"                 // KILOLUX_VERSION
#include "host/gpu/buffer.h"                   // DeviceArray, GrowingBuffer, upload, download
#include "host/gpu/device.h"                   // choose_device, Gpu
#include "host/gpu/features.h"                 // KernelFeatures, Tuning
#include "host/gpu/flow.h"                     // what passes between stages
#include "host/gpu/program.h"                  // in_stage: OpenCL's errors with the stage's name
#include "host/gpu/stage_timer.h"              // times by stage
#include "host/gpu/tuning/tuning_store.h"  // known_tuning: the best work sizes known of a device
#include "host/stages/lights/move_lights.h"
#include "host/stages/lights/prepare_lights.h"
#include "host/stages/lists/bin_pixels.h"
#include "host/stages/lists/build_clusters.h"
#include "host/stages/lists/count_lights.h"
#include "host/stages/lists/count_pairs.h"
#include "host/stages/lists/cull_lights.h"
#include "host/stages/lists/refine_lights.h"
#include "host/stages/picture/bloom.h"
#include "host/stages/picture/pack_radiance.h"
#include "host/stages/picture/tonemap.h"
#include "host/stages/shading/shade.h"
#include "host/stages/surfaces/decode_gbuffer.h"
#include "host/stages/surfaces/repack_gbuffer.h"
#include "kernels/shared/evaluate_modes.h"  // SHADING_*
#include "kernels/shared/gbuffer.h"         // planes, octahedral_encode
#include "kernels/shared/tone_curve.h"      // TONE_CURVE_*
// IWYU pragma: end_exports
