// SPDX-License-Identifier: Apache-2.0
// Places of a work-group's flagged things in their order, from ballots of 32 in local memory.
#ifndef KILOLUX_DEVICE_GROUP_BALLOT_H
#define KILOLUX_DEVICE_GROUP_BALLOT_H

// Words of three ballots of `flags` bits.
#define BALLOT_WORDS(flags) (3 * (((flags) + 31) / 32))

typedef struct GroupBallot {
    uint flag;    // the work-item's own
    uint before;  // set flags of the work-items before it
    uint total;   // set flags of the group
} GroupBallot;

// All work-items clear the ballots before the first turn. A barrier must follow.
static inline void clear_ballots(uint flags, uint group, local uint* ballots) {
    for (uint i = get_local_id(0); i < BALLOT_WORDS(flags); i += group) ballots[i] = 0u;
}

// flag: the work-item's, 0 or 1. ballots: [BALLOT_WORDS(group)]. turn: of the calls, ascending. All
// work-items of the group must come here. Turn t clears the words of turn t-1. Turn t+2 sets them
// again. So one barrier suffices. The flag comes back from local memory, since PoCL 3.1 may lose a
// value that a branch made before a barrier.
static inline GroupBallot group_ballot(uint flag, uint group, uint turn, local uint* ballots) {
    uint bit = get_local_id(0), words = BALLOT_WORDS(group) / 3u;
    local uint* mine = ballots + turn % 3u * words;
    if (flag != 0u) atomic_or(mine + bit / 32u, 1u << (bit % 32u));
    barrier(CLK_LOCAL_MEM_FENCE);
    local uint* last = ballots + (turn + 2u) % 3u * words;
    for (uint i = get_local_id(0); i < words; i += group) last[i] = 0u;
    uint own = mine[bit / 32u];
    GroupBallot out = {own >> (bit % 32u) & 1u, popcount(own & ((1u << (bit % 32u)) - 1u)), 0u};
    for (uint word = 0; word < words; ++word) {
        uint count = popcount(mine[word]);
        out.before += word < bit / 32u ? count : 0u;
        out.total += count;
    }
    return out;
}
#endif
