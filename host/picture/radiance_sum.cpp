// SPDX-License-Identifier: Apache-2.0
#include "host/picture/radiance_sum.h"

#include <cassert>

namespace kilolux {

void RadianceSum::clear() {
    sums_.clear();
    count_ = 0;
}

void RadianceSum::add(const Radiance& radiance) {
    view_ = radiance.view;
    const std::size_t size = std::size_t{3} * view_.stride * view_.height;
    sums_.resize(size);
    const auto planes = download<float>(gpu_, radiance.planes, size);
    for (std::size_t i = 0; i < size; ++i) sums_[i] += planes[i];
    ++count_;
}

Radiance RadianceSum::mean() {
    assert(count_ > 0);
    std::vector<float> planes(sums_.size());
    for (std::size_t i = 0; i < planes.size(); ++i) {
        planes[i] = static_cast<float>(sums_[i] / count_);
    }
    Radiance out{mean_.reserve(planes.size() * sizeof(float)), view_};
    upload<float>(gpu_, out.planes, planes);
    return out;
}

}  // namespace kilolux
