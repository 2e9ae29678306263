// bind_images.cpp — images of labels and values as arrays with an affine, their meshes, and fields of a body on their voxels.
//
// An affine is (4, 4), from a voxel (i, j, k, 1) to its centre in RAS and millimetres, as nibabel has it. Arrays are (i, j, k), or (i, j, k, c).
#include <nanobind/stl/tuple.h>

#include <cstring>

#include "bind.h"
#include "glisson/image/body_image.h"
#include "glisson/image/clean_labels.h"
#include "glisson/image/image_body.h"
#include "glisson/image/read_image.h"
#include "glisson/image/write_image.h"
#include "rooms.h"

namespace glisson::python {
namespace {

struct Labels : nb::object {
  NB_OBJECT_DEFAULT(Labels, object, "numpy.typing.NDArray[numpy.uint16]", ArrayLike::check_any)
  using Scalar = std::uint16_t;
};
struct Floats : nb::object {
  NB_OBJECT_DEFAULT(Floats, object, "numpy.typing.NDArray[numpy.float32]", ArrayLike::check_any)
  using Scalar = float;
};
using Names = std::map<int, std::string>;

Doubles affine_of(const ImageGrid& grid) {
  std::vector<double> rows;
  for (std::size_t r = 0; r < 3; ++r)
    rows.insert(rows.end(),
                {1e3 * grid.axes(r, 0), 1e3 * grid.axes(r, 1), 1e3 * grid.axes(r, 2), 1e3 * grid.origin[r]});
  rows.insert(rows.end(), {0.0, 0.0, 0.0, 1.0});
  return owned<Doubles>(std::move(rows), {4, 4});
}

ImageGrid grid_of(const std::array<std::size_t, 3>& shape, const ArrayLike& affine) {
  const nb::object rows = nb::module_::import_("numpy").attr("ascontiguousarray")(affine, "float64");
  const auto numbers = nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(rows);
  if (numbers.ndim() != 2 || numbers.shape(0) != 4 || numbers.shape(1) != 4)
    throw nb::value_error("the affine is no (4, 4) array: from a voxel (i, j, k, 1) to RAS in mm");
  ImageGrid grid;
  grid.size = shape;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) grid.axes(r, c) = 1e-3 * numbers.data()[4 * r + c];
    grid.origin[r] = 1e-3 * numbers.data()[4 * r + 3];
  }
  const Vec3d s = grid.spacing();
  if (!(grid.voxel_volume() > 1e-6 * s.x * s.y * s.z) || !std::isfinite(norm(grid.origin)))
    throw nb::value_error("the axes of the affine span no volume, or are not finite");
  return grid;
}

/// An array as numbers, i fastest. @param dims  3, or 4 where a voxel may have several
template <class T>
std::vector<T> voxels_of(const ArrayLike& given, const char* type, std::size_t dims, std::vector<std::size_t>& shape) {
  const nb::object array = nb::module_::import_("numpy").attr("asfortranarray")(given, type);
  const auto numbers = nb::cast<nb::ndarray<const T, nb::f_contig, nb::device::cpu>>(array);
  if (numbers.ndim() < 3 || numbers.ndim() > dims || numbers.size() == 0)
    throw nb::value_error(("an image is an array of (i, j, k)" +
                           std::string(dims > 3 ? " or (i, j, k, components)" : "") + "; this one has " +
                           std::to_string(numbers.ndim()) + " dimensions and " + std::to_string(numbers.size()) +
                           " numbers")
                              .c_str());
  for (std::size_t d = 0; d < numbers.ndim(); ++d) shape.push_back(numbers.shape(d));
  return {numbers.data(), numbers.data() + numbers.size()};
}

/// Whole numbers from 0 to 65535. @throws NotLabels naming the first voxel that is none
LabelImage label_image_of(const ArrayLike& given, const ArrayLike& affine, const Names& names, std::string source) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  const nb::object array = numpy.attr("asarray")(given);
  const nb::object is_label =
      numpy.attr("equal")(numpy.attr("mod")(array, 1), 0) & array.attr("__ge__")(0) & array.attr("__le__")(65535);
  if (!nb::cast<bool>(numpy.attr("all")(is_label).attr("item")())) {
    const nb::object place =
        nb::object(numpy.attr("argwhere")(numpy.attr("logical_not")(is_label)))[0].attr("tolist")();
    const nb::object value = array[nb::tuple(place)].attr("item")();
    throw NotLabels(source + ": voxel " + nb::cast<std::string>(nb::repr(nb::tuple(place))) + " is " +
                    nb::cast<std::string>(nb::repr(value)) +
                    ", which is no label; allowed: whole numbers from 0 to 65535");
  }
  LabelImage image;
  std::vector<std::size_t> shape;
  image.voxels = voxels_of<std::uint16_t>(nb::borrow<ArrayLike>(array), "uint16", 3, shape);
  image.grid = grid_of({shape[0], shape[1], shape[2]}, affine);
  image.whole = image.grid.size;
  image.names = names;
  image.source = std::move(source);
  return image;
}

/// What an image holds, as a view of (i, j, k) that keeps it alive.
template <class Array, class Image>
Array voxels_view(nb::handle self) {
  const auto& image = nb::cast<const Image&>(self);
  const auto n = image.grid.size;
  const auto signed_of = [](std::size_t x) { return static_cast<std::int64_t>(x); };
  nb::ndarray<nb::numpy, const typename Array::Scalar> array(image.voxels.data(), {n[0], n[1], n[2]}, self,
                                                             {1, signed_of(n[0]), signed_of(n[0] * n[1])});
  return nb::steal<Array>(array.cast(nb::rv_policy::reference).release());
}

/// (i, j, k), or (i, j, k, c) of several components.
Floats values_array(ValueImage image) {
  const auto n = image.grid.size;
  const auto c = static_cast<std::size_t>(image.components);
  const Floats array = owned<Floats>(std::move(image.values), {c, n[2], n[1], n[0]});
  nb::object turned = array.attr("transpose")(3, 2, 1, 0);
  if (c == 1) turned = turned.attr("__getitem__")(nb::make_tuple(nb::ellipsis(), 0));
  return nb::borrow<Floats>(turned);
}

void bind_kinds(nb::module_& m) {
  nb::class_<LabelImage>(m, "LabelImage", "Labels on a grid in space: 0 is the background.")
      .def(
          "__init__",
          [](LabelImage* self, const ArrayLike& voxels, const ArrayLike& affine, const Names& names,
             const std::string& source) { new (self) LabelImage(label_image_of(voxels, affine, names, source)); },
          "voxels"_a, "affine"_a, "names"_a = Names{}, "source"_a = "array",
          "Copies an array of (i, j, k): whole numbers from 0 to 65535, of any type.\n\n"
          ":param affine: (4, 4), from a voxel (i, j, k, 1) to RAS in mm\n:param names: of labels\n"
          ":param source: what messages call it\n:raises ValueError: with the first voxel that is no label")
      .def_prop_ro("voxels", voxels_view<Labels, LabelImage>, "The labels, (i, j, k): a view.",
                   nb::sig("def voxels(self) -> numpy.typing.NDArray[numpy.uint16]"))
      .def_prop_ro(
          "affine", [](const LabelImage& image) { return affine_of(image.grid); }, "(4, 4), from a voxel to RAS in mm.")
      .def_ro("names", &LabelImage::names, doc("LabelImage::names"))
      .def_ro("notes", &LabelImage::notes, doc("ImageFrame::notes"))
      .def_ro("source", &LabelImage::source, doc("ImageFrame::source"))
      .def(
          "__reduce__",
          [](nb::handle self) {
            return nb::make_tuple(self.type(), nb::make_tuple(self.attr("voxels"), self.attr("affine"),
                                                              self.attr("names"), self.attr("source")));
          },
          nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"))
      .def("__repr__", [](const LabelImage& image) {
        const auto& n = image.grid.size;
        return "<LabelImage of " + std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]) +
               " voxels, " + std::to_string(image.names.size()) + " names>";
      });
  nb::class_<GreyImage>(m, "GreyImage", "Values on a grid in space, NaN where there is none.")
      .def_prop_ro("voxels", voxels_view<Floats, GreyImage>, "The values, (i, j, k): a view.",
                   nb::sig("def voxels(self) -> numpy.typing.NDArray[numpy.float32]"))
      .def_prop_ro(
          "affine", [](const GreyImage& image) { return affine_of(image.grid); }, "(4, 4), from a voxel to RAS in mm.")
      .def_ro("notes", &GreyImage::notes, doc("ImageFrame::notes"))
      .def_ro("source", &GreyImage::source, doc("ImageFrame::source"));
}

void bind_files(nb::module_& m) {
  m.def(
      "read_label_image",
      [](const std::filesystem::path& file, const std::vector<int>& crop_to, std::size_t margin) {
        return read_label_image(file, {crop_to, margin, {}, false});
      },
      "file"_a, "crop_to"_a = std::vector<int>{}, "margin"_a = 0, doc("read_label_image"));
  m.def(
      "read_grey_image", [](const std::filesystem::path& file) { return read_grey_image(file, {.gaps = true}); },
      "file"_a, doc("read_grey_image"));
  m.def(
      "write_label_image",
      [](const std::filesystem::path& file, const LabelImage& image, const std::string& description) {
        write_nifti(file, image, description);
      },
      "file"_a, "image"_a, "description"_a = "", "Writes labels and their names as NIfTI-1 (.nii, .nii.gz).");
  m.def(
      "write_values",
      [](const std::filesystem::path& file, const ArrayLike& values, const ArrayLike& affine, VoxelValues kind,
         const std::string& description) {
        std::vector<std::size_t> shape;
        ValueImage image;
        image.values = voxels_of<float>(values, "float32", 4, shape);
        image.grid = grid_of({shape[0], shape[1], shape[2]}, affine);
        image.components = shape.size() == 4 ? static_cast<int>(shape[3]) : 1;
        write_nifti(file, image, kind, description);
      },
      "file"_a, "values"_a, "affine"_a, "kind"_a = VoxelValues::plain, "description"_a = "", doc("write_nifti"));
}

/// The groups as labels, by their numbers.
LabelImage labels_of(const GroupImage& groups, const LabelImage& from) {
  LabelImage image;
  static_cast<ImageFrame&>(image) = from;
  image.grid = groups.grid;
  image.whole = groups.grid.size;
  for (const std::uint8_t v : groups.voxels)
    image.voxels.push_back(v == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(groups.groups[v - 1U].number()));
  for (const LabelGroup& g : groups.groups) image.names[g.number()] = g.name;
  return image;
}

void bind_meshing(nb::module_& m) {
  Results<LabelFigures>(m, "LabelFigures")
      .read("label", &LabelFigures::label)
      .read("name", &LabelFigures::name)
      .read("voxels", &LabelFigures::voxels)
      .read("volume", &LabelFigures::volume)
      .read("pieces", &LabelFigures::pieces)
      .read("largest_piece", &LabelFigures::largest_piece)
      .read("low", &LabelFigures::low)
      .read("high", &LabelFigures::high)
      .read("at_border", &LabelFigures::at_border);
  m.def("label_figures", label_figures, "image"_a, doc("label_figures"));
  Options<CleanLabels>(m, "CleanLabels");
  m.def(
      "clean_labels",
      [](const LabelImage& image, const std::vector<std::string>& labels, const CleanLabels& options) {
        GroupImage groups = clean_labels(image, label_groups(labels, image.names), options);
        return std::pair(labels_of(groups, image), std::move(groups.report));
      },
      "image"_a, "labels"_a, "options"_a = CleanLabels{},
      "Labels chosen, joined and cleaned, as the program does before it meshes them; and a line for each step, in mL.");
  Options<ImageBody>(m, "ImageBody");
  Results<ImageRegion>(m, "ImageRegion")
      .read("name", &ImageRegion::name)
      .read("label", &ImageRegion::label)
      .read("tets", &ImageRegion::tets)
      .read("volume", &ImageRegion::volume)
      .read("image_volume", &ImageRegion::image_volume)
      .read("pieces", &ImageRegion::pieces)
      .read("image_pieces", &ImageRegion::image_pieces)
      .read("distance_p95", &ImageRegion::distance_p95)
      .read("faces_p95", &ImageRegion::faces_p95);
  Results<ImageMesh>(m, "ImageMesh")
      .read("mesh", &ImageMesh::mesh)
      .read("report", &ImageMesh::report)
      .read("regions", &ImageMesh::regions)
      .read("notes", &ImageMesh::notes);
  m.def(
      "image_mesh",
      [](const ImageBody& body) {
        ImageMesh made = image_mesh(body, [](double) { return PyErr_CheckSignals() == 0; });
        measure_distances(made);
        return made;
      },
      "body"_a, "The mesh of an image, with the distances of its surfaces from the voxels.");
}

void bind_places(nb::module_& m) {
  nb::class_<VoxelPlaces>(m, "VoxelPlaces", doc("VoxelPlaces"))
      .def(
          "__init__",
          [](VoxelPlaces* self, const TetMesh& mesh, const std::array<std::size_t, 3>& shape, const ArrayLike& affine,
             const std::optional<ArrayLike>& positions, const std::vector<bool>& removed) {
            const std::vector<Vec3d> places = positions ? to_vectors(*positions, "positions") : std::vector<Vec3d>{};
            const std::vector<char> gone(removed.begin(), removed.end());
            new (self) VoxelPlaces(mesh, grid_of(shape, affine), places, gone);
          },
          "mesh"_a, "shape"_a, "affine"_a, "positions"_a = nb::none(), "removed"_a = std::vector<bool>{},
          nb::keep_alive<1, 2>(), doc("VoxelPlaces::VoxelPlaces"))
      .def_prop_ro("inside", &VoxelPlaces::inside, doc("VoxelPlaces::inside"))
      .def(
          "vertex_values",
          [](const VoxelPlaces& self, const ArrayLike& values, float outside) {
            const nb::object rows = nb::module_::import_("numpy").attr("ascontiguousarray")(values, "float64");
            const auto numbers = nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(rows);
            const int components = numbers.ndim() == 2 ? static_cast<int>(numbers.shape(1)) : 1;
            return values_array(self.vertex_values({numbers.data(), numbers.size()}, components, outside));
          },
          "values"_a, "outside"_a = NAN,
          "Values at vertices, (n,) or (n, c), linear in each tet: (i, j, k) or (i, j, k, c).")
      .def(
          "tet_values",
          [](const VoxelPlaces& self, const ArrayLike& values, TetValues how, float outside) {
            const nb::object rows = nb::module_::import_("numpy").attr("ascontiguousarray")(values, "float64");
            const auto numbers = nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(rows);
            const int components = numbers.ndim() == 2 ? static_cast<int>(numbers.shape(1)) : 1;
            return values_array(self.tet_values({numbers.data(), numbers.size()}, components, how, outside));
          },
          "values"_a, "how"_a = TetValues::smooth, "outside"_a = NAN,
          "Values of tets, (m,) or (m, c): by means at the vertices of a region, or each tet's `own`.")
      .def("labels", &VoxelPlaces::labels, "outside"_a = 0, doc("VoxelPlaces::labels"));
}

}  // namespace

void bind_images(nb::module_& m) {
  bind_kinds(m);
  bind_files(m);
  bind_meshing(m);
  bind_places(m);
}

}  // namespace glisson::python
