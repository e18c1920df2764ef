// What a snapshot does to the image of a part.
#pragma once

#include "kds/framework/snapshot.hpp"

#include <catch2/catch.hpp>

namespace kds::collision::tests {

/// The image, written and read again.
template <class Image>
Image through_bytes(Image image) {
  kds::detail::Writer writer;
  writer(image);
  const auto bytes = writer.take();
  kds::detail::Reader reader(bytes);
  Image loaded;
  reader(loaded);
  REQUIRE(reader.at_end());
  return loaded;
}

}  // namespace kds::collision::tests
