// SPDX-License-Identifier: Apache-2.0
// Libraries stay loaded in programs whose leaks are checked. Drivers unload theirs at the end, with
// threads of theirs still alive: the check then crashes on those threads' storage, and cannot name
// the library that a leak came from.
extern "C" int dlclose(void*) { return 0; }
