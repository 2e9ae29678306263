// labels_of_body.h — the labels of a body, from its file or from memory.
#pragma once

#include "glisson/image/image_body.h"
#include "glisson/image/read_image.h"

namespace glisson::image {

/// Names of the labels. @throws ImageError
std::map<int, std::string> label_names(const ImageBody& body);
ImageGrid whole_grid(const ImageBody& body);
/// @throws ImageError as read_label_image
LabelImage body_labels(const ImageBody& body, const ReadImageOptions& reading);

/// The box around labels in an image, with a margin. @throws ImageError for one that no voxel has
LabelImage cropped(const LabelImage& image, const ReadImageOptions& reading);

/// @throws ImageError: no voxel has the label; the message lists what there is
[[noreturn]] void fail_without_label(const std::string& source, int label, const std::map<int, std::string>& names,
                                     const std::vector<int>& found);

}  // namespace glisson::image
