// Labels of an image, read and counted by somebody else's program.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "glisson/image/read_image.h"

int main() {
  {
    std::ofstream file("cube.mha", std::ios::binary);
    file
        << "ObjectType = Image\nNDims = 3\nBinaryData = True\nElementSpacing = 1 1 1\nOffset = 0 0 0\nDimSize = 3 3 3\n"
           "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
    for (int k = 0; k < 27; ++k) file.put(k == 13 ? 7 : 0);
  }
  const glisson::LabelImage image = glisson::read_label_image("cube.mha");
  const auto count = std::count(image.voxels.begin(), image.voxels.end(), 7);
  std::printf("%d voxel of label 7\n", static_cast<int>(count));
  return count == 1 ? 0 : 1;
}
