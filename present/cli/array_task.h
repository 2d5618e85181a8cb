// SPDX-License-Identifier: Apache-2.0
// Which task of a scheduler's array this process is, by the variables that schedulers set.
#pragma once

#include <array>
#include <string>

#include "present/cli/sequence.h"

namespace kilolux {

/// The variables of one scheduler. Those that it does not set are null.
struct ArrayVariables {
    const char* scheduler;
    const char* index;
    const char* count;
    const char* first;  // the least index
    const char* step;   // between indices
    int base;           // the usual least index
};

/// Of a task one index is set.
inline constexpr auto kArrayVariables = std::to_array<ArrayVariables>({
    {"Slurm", "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN",
     "SLURM_ARRAY_TASK_STEP", 0},
    {"Kubernetes", "JOB_COMPLETION_INDEX", nullptr, nullptr, nullptr, 0},
    {"AWS Batch", "AWS_BATCH_JOB_ARRAY_INDEX", "AWS_BATCH_JOB_ARRAY_SIZE", nullptr, nullptr, 0},
    {"Open MPI", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr, nullptr, 0},
    {"GNU parallel", "PARALLEL_SEQ", nullptr, nullptr, nullptr, 1},
});

/// The help text of --shard; `parts` is what is divided, such as "frame or tile".
std::string shard_meaning(const std::string& parts);

/// Notes the variable that gave the shard, if there is one.
void note_shard(const Shard& shard);

/// This task's shard of as many as the scheduler has tasks. Throws UsageError that starts with
/// `option` where no index or several are set, or the scheduler does not tell the number.
Shard shard_of_task(const std::string& option);

/// This task's shard of `count`, where the scheduler's least index is the usual one: also right
/// where some tasks of an array are run again. Throws UsageError.
Shard shard_of_task(const std::string& option, int count);

}  // namespace kilolux
