// SPDX-License-Identifier: Apache-2.0
// Prefetches cache lines that are used soon. A CPU's own prefetchers follow streams; the rows of a
// tile are no stream, since each lies a picture's row apart. A request past the end of a buffer has
// no effect. OpenCL's prefetch() is empty in PoCL; clang's builtin is not. PREFETCH: 1 if it is
// wanted.
#ifndef KILOLUX_DEVICE_PREFETCH_H
#define KILOLUX_DEVICE_PREFETCH_H

#ifndef PREFETCH
#define PREFETCH 0
#endif
#if PREFETCH && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define prefetch_to_read(address) __builtin_prefetch(address, 0)
#define prefetch_to_write(address) __builtin_prefetch(address, 1)
#endif
#endif
#ifndef prefetch_to_read
#define prefetch_to_read(address)
#define prefetch_to_write(address)
#endif
#endif
