// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/order_tiles.h"

namespace kilolux {

OrderTiles::OrderTiles(const Gpu& gpu, const Tuning& tuning, std::string_view stage)
    : group_(tuning.prefix_group),
      kernel_(gpu, build_program(gpu, "order_tiles", BuildOptions().define("GROUP", group_)), stage,
              "order_tiles"),
      order_(gpu, stage) {}

DeviceArray<uint> OrderTiles::enqueue(const DeviceArray<uint>& offsets, uint tiles,
                                      StageTimer& timer) {
    const DeviceArray<uint> order = order_.reserve(tiles);
    kernel_.enqueue(groups(1, group_), timer, tiles, offsets, order);
    return order;
}

}  // namespace kilolux
