// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <vector>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "present/exit_code.h"
#include "present/program.h"

int main(int argc, char** argv) {
    kilolux::catch_signals();
    kilolux::end_on_uncaught_exceptions();
    kilolux::show_waits();
    return kilolux::exit_code_of([&] {
        kilolux::Program program;
        program.run(std::vector<std::string>(argv + 1, argv + argc));
        if (std::fflush(stdout) != 0) throw kilolux::Error("standard output: cannot write");
    });
}
