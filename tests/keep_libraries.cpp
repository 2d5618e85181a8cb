// SPDX-License-Identifier: Apache-2.0
// Keeps libraries loaded in programs whose leaks are checked. Drivers unload theirs at the end,
// while their threads are still alive: the check then crashes on those threads' storage, and cannot
// name the library of a leak.
extern "C" int dlclose(void*) { return 0; }
