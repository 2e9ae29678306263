// read_image.h — images of files and of bytes that stand for them.
#pragma once

#include "glisson/image/read_image.h"
#include "image/read/byte_stream.h"

namespace glisson::image {

/// @throws ImageError
LabelImage read_labels(const ByteSource& source, const ReadImageOptions& options);
GreyImage read_grey(const ByteSource& source, const ReadImageOptions& options);

}  // namespace glisson::image
