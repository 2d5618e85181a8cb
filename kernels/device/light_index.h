// SPDX-License-Identifier: Apache-2.0
// The type of a light's index in lists: 16 bits while they suffice. Chosen by the host.
#ifndef KILOLUX_DEVICE_LIGHT_INDEX_H
#define KILOLUX_DEVICE_LIGHT_INDEX_H
#ifndef LIGHT_INDEX
#define LIGHT_INDEX uint
#endif
#endif
