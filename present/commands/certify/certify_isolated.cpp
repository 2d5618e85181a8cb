// SPDX-License-Identifier: Apache-2.0
#include "present/commands/certify/certify_isolated.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "host/base/system/child_process.h"
#include "host/base/system/interrupt.h"
#include "host/base/system/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The output of `kilolux certify` with these words; or how it ended, if it wrote nothing.
struct Outcome {
    Json certificate;
    std::string error;
};

Outcome run(const std::string& device, std::vector<std::string> more) {
    const TemporaryFolder scratch;
    const fs::path file = scratch / "result.json";
    std::vector<std::string> words = {"timeout", "--foreground", fmt::to_string(kIsolatedSeconds),
                                      fs::read_symlink("/proc/self/exe").string(), "certify"};
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), {"--quiet", "-o", file.string()});
    if (!device.empty()) words.insert(words.end(), {"--device", device});
    ChildProcess child(words);
    child.succeeded();
    check_interrupt();
    std::ifstream in(file);
    const Json found = Json::parse(in, nullptr, false);
    if (!found.is_discarded()) return {found, ""};
    constexpr int kTimedOut = 124;  // as timeout(1) says
    std::string error = child.ending() == fmt::format("exit code {}", kTimedOut)
                            ? fmt::format("the process took longer than {} s", kIsolatedSeconds)
                            : "the process ended with " + child.ending();
    const std::vector<std::string> messages = child.messages();
    if (!messages.empty()) error += ": " + messages.back();
    return {Json(), error};
}

void add_case(HardCaseRow& row, const std::string& device, int lanes) {
    row.lanes.push_back(lanes);
    const Outcome outcome =
        run(device, {"--case", std::string(row.hard_case.label), "--lanes", fmt::to_string(lanes)});
    if (!outcome.error.empty()) {
        row.error = fmt::format("{} lanes: {}", lanes, outcome.error);
        return;
    }
    const HardCaseRow found = rows_of_json(outcome.certificate).at(0);
    row.findings.merge(found.findings);
    if (!found.error.empty()) row.error = found.error;
}

Json part_of(const std::string& device, const std::string& name) {
    const Outcome outcome = run(device, {"--case", "none", "--with", name});
    if (!outcome.error.empty()) return {{"passed", false}, {"error", outcome.error}};
    return outcome.certificate.at(name);
}

}  // namespace

Certificate certify_isolated(const IsolatedRequest& request, const std::function<void()>& step) {
    Certificate out;
    for (const HardCase& hard_case : request.cases) {
        HardCaseRow& row = out.rows.emplace_back(HardCaseRow{hard_case, {}, {}, {}});
        for (const int lanes : request.lanes) {
            add_case(row, request.device, lanes);
            step();
        }
    }
    for (const CertificatePart& part : request.parts) {
        out.parts[part.name] = part_of(request.device, part.name);
        step();
    }
    return out;
}

}  // namespace kilolux
