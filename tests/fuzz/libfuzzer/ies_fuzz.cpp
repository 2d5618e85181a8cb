// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/libfuzzer/entry.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    return kilolux::write_corpus(*argc, *argv, kilolux::ies_corpus());
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    kilolux::fuzz_ies({bytes, size});
    return 0;
}
