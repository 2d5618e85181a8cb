/* SPDX-License-Identifier: Apache-2.0 */
/* The library in C: lights what another renderer drew, in its own buffers or images.
 *
 *     kilolux_lighting* lighting = NULL;
 *     if (kilolux_create(context, queue, &formats, &lighting) != 0) puts(kilolux_error());
 *     kilolux_set_lights(lighting, lights, count, NULL, 0);
 *     kilolux_light_frame(lighting, &frame);
 *     kilolux_destroy(lighting);
 *
 * Functions return 0, or 1 after an error; then nothing has changed but the output's pixels, and
 * kilolux_error() says what, where and the value seen. Only when the device's memory ends in
 * kilolux_set_lights() the lights before are lost, too: set them again. No C++ exception comes out.
 * A handle may be used by one thread at a time, several handles by several.
 *
 * Structs begin as zeros: `kilolux_frame frame = {0};`. Every value 0 is the default said here.
 * The buffers and images are the caller's; the library reads and writes them, and holds none after
 * a call. Matrices: column by column, for column vectors, as OpenGL has them. */
#ifndef KILOLUX_C_H
#define KILOLUX_C_H

#include <CL/cl.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef struct kilolux_lighting kilolux_lighting;

enum { KILOLUX_LAMBERT = 0, KILOLUX_BLINN_PHONG = 1, KILOLUX_PBR = 2 };
enum { KILOLUX_DEPTH_FLOAT32 = 0, KILOLUX_DEPTH_LOWER_24 = 1, KILOLUX_DEPTH_UPPER_24 = 2 };
enum { KILOLUX_NORMAL_RGBA8 = 0, KILOLUX_NORMAL_OCTAHEDRAL16 = 1, KILOLUX_NORMAL_FLOAT4 = 2 };
enum { KILOLUX_ALBEDO_SRGB8 = 0, KILOLUX_ALBEDO_HALF4 = 1 };
enum { KILOLUX_RADIANCE_FLOAT4 = 0, KILOLUX_RADIANCE_HALF4 = 1, KILOLUX_RADIANCE_IMAGE = 2 };

/* How a renderer stores its G-buffer, and what of it is lit how. Pixels have 4 bytes, a float4 has
 * 16 and a half4 has 8; the fourth channel of the albedo is the perceptual roughness. */
typedef struct kilolux_formats {
    int shading;            /* KILOLUX_LAMBERT, ... */
    int depth;              /* KILOLUX_DEPTH_*: the depth buffer's values */
    int normal;             /* KILOLUX_NORMAL_*: 8 and 16 bits hold (v + 1) / 2 */
    int albedo;             /* KILOLUX_ALBEDO_* */
    int radiance;           /* KILOLUX_RADIANCE_*: linear Rec. 709, alpha 1, 0 for background */
    int images;             /* 1: depth, normals and albedo are 2D images */
    int view_space_normals; /* 1: in view space, x right, y up, z towards the viewer */
} kilolux_formats;

/* A point or spot light of the world. */
typedef struct kilolux_light {
    double position[3];         /* [m] */
    float range;                /* [m], > 0: its light is exactly 0 beyond */
    float intensity[3];         /* linear Rec. 709 [cd] */
    int is_spot;                /* 1: the following hold */
    float axis[3];              /* unit vector of the world, from the light */
    float cos_inner, cos_outer; /* cosines of the half angles within and beyond which it is
                                   constant and 0 */
} kilolux_light;

/* Parallel light. */
typedef struct kilolux_directional_light {
    float to_light[3];    /* unit vector of the world */
    float illuminance[3]; /* linear Rec. 709 [lx] */
} kilolux_directional_light;

/* One frame to light. All buffers: [height][pitch] pixels, rows from the top, elements aligned to
 * their size. */
typedef struct kilolux_frame {
    double view[16];       /* view space from world: rotation and translation */
    double projection[16]; /* clip space from view, normalised +Y up; reversed depth and an infinite
                              far plane are found out */
    uint32_t width, height; /* [pixel] */
    int opengl_depth;       /* 1: normalised depth is -1..1; else 0..1 */
    int left_handed;        /* 1: an orthographic camera looks down +Z (perspective ones tell) */
    cl_mem depth, normal, albedo;
    uint32_t pitch;          /* of these, where they are buffers [pixel]; 0: width */
    cl_mem radiance;         /* out */
    uint32_t radiance_pitch; /* [pixel]; 0: width */
    float ambient;           /* radiance from everywhere */
    float nearest, farthest; /* [m] depths between which most pixels lie: only the time depends on
                                them; 0: 0.1 and 100 */
} kilolux_frame;

/* Compiles. `queue` is in order, with profiling. Context and queue are retained until
 * kilolux_destroy(). Work sizes are the best that are known of the device. */
int kilolux_create(cl_context context, cl_command_queue queue, const kilolux_formats* formats,
                   kilolux_lighting** out);
void kilolux_destroy(kilolux_lighting* lighting); /* NULL: nothing */

/* The lights from now on; copied, and kept on the device. Compiles when the kinds of lights or the
 * size of their indices (65536) change. */
int kilolux_set_lights(kilolux_lighting* lighting, const kilolux_light* lights, size_t count,
                       const kilolux_directional_light* directional, size_t directional_count);

/* Moves the lights relative to the camera on the device, makes the lists, shades. Reads what the
 * queue wrote before; for other queues' work, clEnqueueBarrierWithWaitList() first. Blocks once,
 * until the picture is done. */
int kilolux_light_frame(kilolux_lighting* lighting, const kilolux_frame* frame);

/* What failed last in this thread; "" before. Valid until the next call in this thread. */
const char* kilolux_error(void);

/* Of the library that is linked: "0.1.0". */
const char* kilolux_version(void);

#if defined(__cplusplus)
}
#endif
#endif
