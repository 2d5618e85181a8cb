/* SPDX-License-Identifier: Apache-2.0 */
/* A C program against the installed library: a plane 2 m ahead under one light, whose radiance is
 * known, and errors. Prints nothing but what is wrong. */
#ifndef CL_TARGET_OPENCL_VERSION /* CL/cl.h takes the newest, with a note for each file */
#error Kilolux::c and kilolux-c.pc do not say the version of OpenCL
#endif
#include <kilolux/kilolux_c.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 33
#define HEIGHT 17
#define PIXELS (WIDTH * HEIGHT)

static int failures = 0;

static void expect(int holds, const char* what, double value) {
    if (holds) return;
    ++failures;
    fprintf(stderr, "%s: %g: %s\n", what, value, kilolux_error());
}

static cl_mem new_buffer(cl_context context, size_t bytes, void* from) {
    const cl_mem_flags flags = from != NULL ? CL_MEM_COPY_HOST_PTR : CL_MEM_READ_WRITE;
    return clCreateBuffer(context, flags, bytes, from, NULL);
}

/* Reversed depth without a far plane: d = near / z. The camera stands at x = 1e6. */
static kilolux_frame plane_frame(cl_context context) {
    static const double view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1e6, 0, 0, 1};
    static const double projection[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0.1, 0};
    static float depth[PIXELS];
    static unsigned char normal[PIXELS][4], albedo[PIXELS][4];
    kilolux_frame frame;
    int i;
    for (i = 0; i < PIXELS; ++i) {
        depth[i] = i == 0 ? 0.0f : 0.05f; /* 2 m; background */
        normal[i][0] = normal[i][1] = 128;
        normal[i][2] = 255;
        memset(albedo[i], 255, 4);
    }
    memset(&frame, 0, sizeof(frame));
    memcpy(frame.view, view, sizeof(view));
    memcpy(frame.projection, projection, sizeof(projection));
    frame.width = WIDTH;
    frame.height = HEIGHT;
    frame.depth = new_buffer(context, sizeof(depth), depth);
    frame.normal = new_buffer(context, sizeof(normal), normal);
    frame.albedo = new_buffer(context, sizeof(albedo), albedo);
    frame.radiance = new_buffer(context, PIXELS * 16, NULL);
    return frame;
}

/* Input that every call refuses before the device gets any. */
static void expect_refusals(kilolux_lighting* lighting, const kilolux_frame* good) {
    kilolux_light light = {{0, 0, 0}, 1.0f, {1, 1, 1}, 1, {0, 0, 0}, 0.9f, 0.8f};
    kilolux_directional_light directional = {{0, 0, 2}, {1, 1, 1}};
    kilolux_frame frame = *good;
    expect(kilolux_set_lights(NULL, NULL, 0, NULL, 0) == 1, "no handle", 0);
    expect(kilolux_set_lights(lighting, NULL, 3, NULL, 0) == 1, "no lights", 0);
    expect(strcmp(kilolux_error(), "kilolux_set_lights: an argument is NULL") == 0, "message", 0);
    expect(kilolux_set_lights(lighting, &light, 1, NULL, 0) == 1, "a spot without an axis", 0);
    expect(strstr(kilolux_error(), "light 0: its axis is no unit vector") != NULL, "message", 0);
    expect(kilolux_set_lights(lighting, NULL, 0, &directional, 1) == 1, "a long direction", 0);
    expect(strstr(kilolux_error(), "directional light 0: to_light is no unit vector") != NULL, "message", 0);
    expect(kilolux_light_frame(NULL, good) == 1, "no handle", 0);
    expect(kilolux_light_frame(lighting, NULL) == 1, "no frame", 0);
    frame.normal = NULL;
    expect(kilolux_light_frame(lighting, &frame) == 1, "no normals", 0);
    expect(strstr(kilolux_error(), "normals: there is none") != NULL, "message", 0);
    frame = *good;
    frame.height = 0;
    expect(kilolux_light_frame(lighting, &frame) == 1, "no pixels", 0);
    expect(strstr(kilolux_error(), "33x0 pixels") != NULL, "message", 0);
    frame = *good;
    frame.ambient = (float)NAN;
    expect(kilolux_light_frame(lighting, &frame) == 1, "ambient", 0);
    expect(strstr(kilolux_error(), "ambient is ") != NULL, "message", 0);
    memset(&frame, 0, sizeof(frame));
    expect(kilolux_light_frame(lighting, &frame) == 1, "zeros", 0);
}

/* The radiance of the frame's pixels under one light, which is set for it. */
static void light_alone(kilolux_lighting* lighting, const kilolux_light* light, const kilolux_frame* frame,
                        cl_command_queue queue, float pixels[PIXELS][4]) {
    expect(kilolux_set_lights(lighting, light, 1, NULL, 0) == 0, "one light", 0);
    expect(kilolux_light_frame(lighting, frame) == 0, "its light", 0);
    clEnqueueReadBuffer(queue, frame->radiance, CL_TRUE, 0, PIXELS * 16, pixels, 0, NULL, NULL);
}

/* Cones wider than 90 degrees, and directions whose length is not quite 1. */
static void expect_spots(kilolux_lighting* lighting, const kilolux_frame* frame, cl_command_queue queue) {
    static float point[PIXELS][4], spot[PIXELS][4], longer[PIXELS][4];
    const int corner = 1, middle = HEIGHT / 2 * WIDTH + WIDTH / 2;
    kilolux_light light = {{1e6, 0.0, 8.0}, 100.0f, {1, 1, 1}, 0, {0, 0, 1}, -0.97f, -0.98f};
    kilolux_directional_light directional = {{0, 0, 1.009f}, {0, 0, 1}};
    light_alone(lighting, &light, frame, queue, point);
    light.is_spot = 1; /* aimed away: the plane is 165 to 180 degrees off its axis */
    light_alone(lighting, &light, frame, queue, spot);
    expect(spot[middle][0] == 0.0f, "behind a wide spot", spot[middle][0]);
    expect(fabs(spot[corner][0] - point[corner][0]) < 1e-6 * point[corner][0], "beside it",
           spot[corner][0] / point[corner][0]);
    light.cos_outer = -1.0f;
    expect(kilolux_set_lights(lighting, &light, 1, NULL, 0) == 1, "a spot without a rim", 0);
    light.position[2] = -1.0;
    light.axis[2] = -1.0f;
    light.cos_inner = 1.0f;
    light.cos_outer = 0.0f;
    light.is_spot = 0;
    light_alone(lighting, &light, frame, queue, point);
    light.is_spot = 1;
    light_alone(lighting, &light, frame, queue, spot);
    light.axis[2] = -1.009f;
    light_alone(lighting, &light, frame, queue, longer);
    expect(spot[corner][0] < 0.2f * point[corner][0], "towards a spot's rim", spot[corner][0]);
    expect(fabs(longer[corner][0] - spot[corner][0]) < 1e-6 * spot[corner][0], "by a longer axis",
           longer[corner][0] / spot[corner][0]);
    light.axis[2] = -1.02f;
    expect(kilolux_set_lights(lighting, &light, 1, NULL, 0) == 1, "an axis that is too long", 0);
    expect(kilolux_set_lights(lighting, NULL, 0, &directional, 1) == 0, "a longer direction", 0);
    expect(kilolux_light_frame(lighting, frame) == 0, "light by it", 0);
    clEnqueueReadBuffer(queue, frame->radiance, CL_TRUE, 0, sizeof(longer), longer, 0, NULL, NULL);
    expect(fabs(longer[middle][2] * 3.14159265358979 - 1.0) < 0.003, "its light", longer[middle][2]);
}

int main(void) {
    cl_platform_id platform;
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    kilolux_formats formats = {0};
    kilolux_light lights[2] = {{{1e6, 0.0, -1.0}, 4.0f, {2.0f, 1.0f, 0.5f}, 0, {0, 0, 0}, 0, 0}};
    kilolux_directional_light directional = {{0, 0, 1}, {0, 0, 1}};
    kilolux_lighting* lighting = NULL;
    kilolux_frame frame;
    float pixels[PIXELS][4];
    const float* middle = pixels[HEIGHT / 2 * WIDTH + WIDTH / 2];
    /* 1 m before the plane: intensity / pi, by the window of its range. */
    const double window = 1.0 - pow(0.25, 4.0);
    const double expected = 2.0 / 3.14159265358979 * window;
    if (clGetPlatformIDs(1, &platform, NULL) != CL_SUCCESS ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL) != CL_SUCCESS) {
        fprintf(stderr, "no OpenCL device\n");
        return 1;
    }
    context = clCreateContext(NULL, 1, &device, NULL, NULL, NULL);
    queue = clCreateCommandQueue(context, device, CL_QUEUE_PROFILING_ENABLE, NULL);

    expect(kilolux_error()[0] == 0, "an error before the first", 0);
    expect(kilolux_create(context, NULL, &formats, &lighting) == 1, "no queue", 0);
    expect(strcmp(kilolux_error(), "kilolux_create: an argument is NULL") == 0, "its message", 0);
    formats.normal = 7;
    expect(kilolux_create(context, queue, &formats, &lighting) == 1, "no such format", 0);
    expect(strstr(kilolux_error(), "normal is 7, must be 0 to 2") != NULL, "its message", 0);
    formats.normal = KILOLUX_NORMAL_RGBA8;
    expect(kilolux_create(context, queue, &formats, &lighting) == 0, "create", 0);
    if (lighting == NULL) return 1;
    lights[1] = lights[0];
    lights[1].range = -1.0f;
    expect(kilolux_set_lights(lighting, lights, 2, NULL, 0) == 1, "a bad range", 0);
    expect(strstr(kilolux_error(), "light 1: range is -1") != NULL, "its message", 0);

    frame = plane_frame(context);
    expect_refusals(lighting, &frame);
    expect(kilolux_set_lights(lighting, lights, 1, NULL, 0) == 0, "lights", 0);
    expect(kilolux_light_frame(lighting, &frame) == 0, "light", 0);
    clEnqueueReadBuffer(queue, frame.radiance, CL_TRUE, 0, sizeof(pixels), pixels, 0, NULL, NULL);
    expect(fabs(middle[0] - expected) < 0.003 * expected, "red", middle[0] / expected);
    expect(fabs(middle[1] - 0.5 * middle[0]) < 1e-6, "green", middle[1]);
    expect(pixels[0][0] == 0.0f && pixels[0][3] == 1.0f, "background", pixels[0][0]);
    expect(pixels[1][0] > 0.0f && pixels[1][0] < 0.5f * middle[0], "corner", pixels[1][0]);

    expect(kilolux_set_lights(lighting, NULL, 0, &directional, 1) == 0, "a directional light", 0);
    expect(kilolux_light_frame(lighting, &frame) == 0, "light by it", 0);
    clEnqueueReadBuffer(queue, frame.radiance, CL_TRUE, 0, sizeof(pixels), pixels, 0, NULL, NULL);
    expect(fabs(middle[2] * 3.14159265358979 - 1.0) < 0.003, "its light", middle[2]);
    expect(middle[0] == 0.0f, "no red", middle[0]);

    expect_spots(lighting, &frame, queue);
    frame.nearest = 5.0f; /* behind all pixels: slower, but the same */
    frame.farthest = 1.0f;
    expect(kilolux_light_frame(lighting, &frame) == 0, "depths in disorder", 0);
    frame.radiance_pitch = 7;
    expect(kilolux_light_frame(lighting, &frame) == 1, "a narrow pitch", 0);
    expect(strstr(kilolux_error(), "pitch is 7") != NULL, "its message", 0);
    kilolux_destroy(lighting);
    kilolux_destroy(NULL);
    clReleaseMemObject(frame.depth);
    clReleaseMemObject(frame.normal);
    clReleaseMemObject(frame.albedo);
    clReleaseMemObject(frame.radiance);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    return failures == 0 ? 0 : 1;
}
