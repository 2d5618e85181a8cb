// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>

#include "host/base/error.h"
#include "host/images/module/parts.h"

namespace kilolux::oiio {
namespace {

SampleType sample_type(OIIO::TypeDesc type) {
    for (const SampleType known :
         {SampleType::uint8, SampleType::uint16, SampleType::uint32, SampleType::half}) {
        if (type == type_of(known)) return known;
    }
    return SampleType::float32;
}

ImageLayout layout_of(const OIIO::ImageSpec& spec, const std::string& where) {
    if (spec.depth > 1) throw Error(where + "is a volume of depth " + std::to_string(spec.depth));
    ImageLayout out{spec.width, spec.height, {}};
    for (int i = 0; i < spec.nchannels; ++i) {
        out.channels.push_back({spec.channel_name(i), sample_type(spec.channelformat(i))});
    }
    if (const auto* found = spec.find_attribute("chromaticities");
        found != nullptr && found->type().basetype == OIIO::TypeDesc::FLOAT &&
        found->type().numelements() * found->type().aggregate == 8) {
        const auto* values = static_cast<const float*>(found->data());
        out.attributes.emplace_back("chromaticities", std::vector<float>(values, values + 8));
    }
    out.associated_alpha = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
    return out;
}

OIIO::ImageSpec as_stored() {
    OIIO::ImageSpec wanted;
    wanted.attribute("oiio:UnassociatedAlpha", 1);
    return wanted;
}

class Reader : public ImageReader {
 public:
    Reader(std::unique_ptr<OIIO::Filesystem::IOMemReader> memory,
           std::unique_ptr<OIIO::ImageInput> input, std::string where)
        : memory_(std::move(memory)),
          input_(std::move(input)),
          where_(std::move(where)),
          layout_(layout_of(input_->spec(), where_)) {}

    const ImageLayout& layout() const override { return layout_; }

    void read(int begin, int end, SampleType type, void* out, std::size_t stride) override {
        if (!input_->read_image(0, 0, begin, end, type_of(type), out,
                                static_cast<OIIO::stride_t>(stride))) {
            throw Error(where_ + input_->geterror());
        }
    }

 private:
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // outlives input_, which reads it
    std::unique_ptr<OIIO::ImageInput> input_;
    std::string where_;  // begins its errors
    ImageLayout layout_;
};

}  // namespace

std::unique_ptr<ImageReader> open_image(const std::filesystem::path& file) {
    const std::string where = file.string() + ": cannot read the image: ";
    const OIIO::ImageSpec wanted = as_stored();
    auto input = OIIO::ImageInput::open(file.string(), &wanted);
    if (!input) throw Error(where + OIIO::geterror());
    return std::make_unique<Reader>(nullptr, std::move(input), where);
}

std::unique_ptr<ImageReader> open_encoded(const std::string& format,
                                          std::span<const unsigned char> bytes) {
    auto input = OIIO::ImageInput::create(format);
    if (!input) {
        const std::string ignored = OIIO::geterror();
        return nullptr;
    }
    auto memory = std::make_unique<OIIO::Filesystem::IOMemReader>(
        OIIO::cspan<unsigned char>(bytes.data(), static_cast<std::ptrdiff_t>(bytes.size())));
    OIIO::ImageSpec spec;
    if (!input->set_ioproxy(memory.get()) || !input->open("image." + format, spec, as_stored())) {
        throw Error(input->geterror());
    }
    return std::make_unique<Reader>(std::move(memory), std::move(input), "");
}

}  // namespace kilolux::oiio
