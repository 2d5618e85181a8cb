// SPDX-License-Identifier: Apache-2.0
// --shard auto, with the variables as schedulers set them.
#include <gtest/gtest.h>
#include <list>
#include <map>
#include <optional>

#include "host/base/error.h"
#include "present/cli/option_values.h"
#include "present/cli/sequence.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using Variables = std::map<const char*, const char*>;

// The environment of a task while it lives: that of no other scheduler.
class Task {
 public:
    explicit Task(const Variables& variables) {
        for (const ArrayVariables& row : kArrayVariables) {
            for (const char* name : {row.index, row.count, row.first, row.step}) {
                if (name != nullptr) set_.emplace_back(name, std::nullopt);
            }
        }
        for (const auto& [name, value] : variables) set_.emplace_back(name, value);
    }

    ~Task() {
        while (!set_.empty()) set_.pop_back();
    }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

 private:
    std::list<EnvironmentVariable> set_;
};

std::string shard_in(const Variables& variables, const char* text) {
    const Task task(variables);
    try {
        const Shard shard = parse_shard("--shard", text);
        return text_of(shard) + " by " + std::string(shard.variable);
    } catch (const UsageError& error) {
        return error.what();
    }
}

const Variables kSlurm = {{"SLURM_ARRAY_TASK_ID", "7"},
                          {"SLURM_ARRAY_TASK_COUNT", "4"},
                          {"SLURM_ARRAY_TASK_MIN", "3"},
                          {"SLURM_ARRAY_TASK_STEP", "2"}};

TEST(ArrayTask, IsTheShardOfItsScheduler) {
    EXPECT_EQ(shard_in(kSlurm, "auto"), "2/4 by SLURM_ARRAY_TASK_ID");
    EXPECT_EQ(
        shard_in({{"AWS_BATCH_JOB_ARRAY_INDEX", "0"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "8"}}, "auto"),
        "0/8 by AWS_BATCH_JOB_ARRAY_INDEX");
    EXPECT_EQ(shard_in({{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "2"}}, "auto"),
              "1/2 by OMPI_COMM_WORLD_RANK");
    EXPECT_EQ(shard_in({{"JOB_COMPLETION_INDEX", "5"}}, "auto/6"), "5/6 by JOB_COMPLETION_INDEX");
    EXPECT_EQ(shard_in({{"PARALLEL_SEQ", "1"}}, "auto/6"), "0/6 by PARALLEL_SEQ");
}

// Two failed tasks that run again have a range of their own, which would be the wrong one.
TEST(ArrayTask, ANumberThatIsGivenCountsForAllTasks) {
    EXPECT_EQ(shard_in({{"SLURM_ARRAY_TASK_ID", "5"},
                        {"SLURM_ARRAY_TASK_COUNT", "1"},
                        {"SLURM_ARRAY_TASK_MIN", "5"},
                        {"SLURM_ARRAY_TASK_STEP", "1"}},
                       "auto/8"),
              "5/8 by SLURM_ARRAY_TASK_ID");
}

TEST(ArrayTask, RefusesWhatIsNoShard) {
    EXPECT_EQ(shard_in({}, "auto"),
              "--shard auto: the environment has none of SLURM_ARRAY_TASK_ID, "
              "JOB_COMPLETION_INDEX, AWS_BATCH_JOB_ARRAY_INDEX, OMPI_COMM_WORLD_RANK, "
              "PARALLEL_SEQ; name the shard as I/N");
    EXPECT_EQ(shard_in({{"JOB_COMPLETION_INDEX", "5"}}, "auto"),
              "--shard auto: Kubernetes does not tell how many tasks there are; write auto/N");
    EXPECT_EQ(shard_in({{"PARALLEL_SEQ", "7"}}, "auto/6"),
              "--shard auto: PARALLEL_SEQ is 7, which is none of 6 tasks from 1 on");
    EXPECT_EQ(shard_in({{"PARALLEL_SEQ", "-1"}}, "auto/6"),
              "--shard auto: PARALLEL_SEQ is '-1', no whole number from 0 on");
    EXPECT_EQ(shard_in({{"OMPI_COMM_WORLD_RANK", "1"}}, "auto"),
              "--shard auto: the environment lacks OMPI_COMM_WORLD_SIZE");
    Variables inner = kSlurm;  // GNU parallel in a task of Slurm
    inner["PARALLEL_SEQ"] = "2";
    EXPECT_EQ(shard_in(inner, "auto/4"),
              "--shard auto: both SLURM_ARRAY_TASK_ID and PARALLEL_SEQ are set; name the shard as "
              "I/N");
    EXPECT_EQ(shard_in({{"PARALLEL_SEQ", ""}}, "auto/4"), shard_in({}, "auto/4"));
    Variables beyond = kSlurm;
    beyond["SLURM_ARRAY_TASK_ID"] = "11";
    EXPECT_EQ(shard_in(beyond, "auto"),
              "--shard auto: SLURM_ARRAY_TASK_ID is 11, which is none of 4 tasks from 3 on");
    Variables gaps = kSlurm;  // --array=3,6,7,10 has the step 1, or none
    gaps["SLURM_ARRAY_TASK_STEP"] = "3";
    EXPECT_EQ(shard_in(gaps, "auto"),
              "--shard auto: Slurm's array is no range of indices; write auto/N");
}

}  // namespace
}  // namespace kilolux
