// command_draw.cpp — glisson plot and glisson picture: charts and bodies of a run as files for a paper.
#include <charconv>
#include <memory>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/drawing.h"
#include "program/exit_code.h"

namespace glisson::app {
namespace {

constexpr const char* kPlotFooter =
    "Writes each chart of OUT/report.html to OUT/plots/TITLE.svg (.png, .pdf), with the lines, names and marks of the "
    "report.\n"
    "OUT is what run, compare, converge or reproduce wrote, or fit: then the measured and simulated curves of\n"
    "OUT/fit.json, and their residuals. The same in Python: glisson.plot.run(OUT).\n"
    "\n"
    "Examples:\n"
    "  glisson plot out/figure2\n"
    "  glisson plot out/my_fit --svg\n"
    "  glisson plot out/figure2 --pdf --png --size-mm 180x90 --chart depth";
constexpr const char* kPictureFooter =
    "Draws a frame of OUT in parallel projection, without a display or a graphics card: the body coloured by a field, "
    "cut\n"
    "open where asked for, with its tools, a colour scale and a length. The same in Python: glisson.picture(OUT).\n"
    "\n"
    "Examples:\n"
    "  glisson picture out/liver --colour von_mises --size 1600x1200\n"
    "  glisson picture out/liver --frame 12 --colour displacement --cut x=0 --file figure.png";

/// Two numbers with an x between them. @throws std::invalid_argument naming the option
template <class Number>
std::pair<Number, Number> two_of(const std::string& option, const std::string& text) {
  std::pair<Number, Number> two{};
  const char *at = text.data(), *end = at + text.size();
  auto read = std::from_chars(at, end, two.first);
  const bool first = read.ec == std::errc() && read.ptr != end && *read.ptr == 'x';
  if (first) read = std::from_chars(read.ptr + 1, end, two.second);
  if (!first || read.ec != std::errc() || read.ptr != end)
    throw std::invalid_argument(option + " is \"" + text + "\"; write two numbers as WIDTHxHEIGHT");
  return two;
}

struct PlotOptions {
  std::string out, folder, chart, size = "88x66";
  std::vector<std::string> variants;
  bool svg = false, png = false, pdf = false;
};

nlohmann::json plot_json(const PlotOptions& options) {
  nlohmann::json formats = nlohmann::json::array();
  if (options.svg || (!options.png && !options.pdf)) formats.push_back("svg");
  if (options.png) formats.push_back("png");
  if (options.pdf) formats.push_back("pdf");
  const auto [width, height] = two_of<double>("--size-mm", options.size);
  nlohmann::json wanted{{"kind", "plot"}, {"out", options.out}, {"formats", formats}, {"size_mm", {width, height}}};
  if (!options.folder.empty()) wanted["folder"] = options.folder;
  if (!options.chart.empty()) wanted["chart"] = options.chart;
  if (!options.variants.empty()) wanted["variants"] = options.variants;
  return wanted;
}

struct PictureOptions {
  std::string out, variant, colour = "displacement", cut, size = "1600x1200", file;
  std::vector<double> range, eye;
  int frame = -1;
  double exaggerate = 1.0;
  bool flip = false, bare = false, no_tools = false;
};

nlohmann::json picture_json(const PictureOptions& options) {
  const auto [width, height] = two_of<int>("--size", options.size);
  nlohmann::json wanted{{"kind", "picture"},
                        {"out", options.out},
                        {"frame", options.frame},
                        {"colour", options.colour},
                        {"flip", options.flip},
                        {"size", {width, height}},
                        {"exaggerate", options.exaggerate},
                        {"labels", !options.bare},
                        {"tools", !options.no_tools}};
  wanted["file"] = options.file.empty() ? options.out + "/picture.png" : options.file;
  if (!options.variant.empty()) wanted["variant"] = options.variant;
  if (!options.cut.empty()) wanted["cut"] = options.cut;
  if (!options.range.empty()) wanted["range"] = options.range;
  if (!options.eye.empty()) wanted["eye"] = options.eye;
  return wanted;
}

}  // namespace

void add_plot(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("plot", "Write the charts of a report as SVG, PNG or PDF");
  auto options = std::make_shared<PlotOptions>();
  command->add_option("OUT", options->out, "folder of a run, or a report.html")->required();
  command->add_flag("--svg", options->svg, "write SVG (default)");
  command->add_flag("--png", options->png, "write PNG, 300 dots per inch");
  command->add_flag("--pdf", options->pdf, "write PDF");
  command->add_option("--out", options->folder, "folder to write to; default: OUT/plots");
  command->add_option("--chart", options->chart, "only charts whose title contains this");
  command->add_option("--variant", options->variants, "only lines of this variant; may be repeated");
  command->add_option("--size-mm", options->size, "width and height in mm")->capture_default_str();
  command->footer(kPlotFooter);
  command->callback([options, &action] { action = [options] { return draw(plot_json(*options)); }; });
}

void add_picture(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("picture", "Draw the body of a run at one instant");
  auto options = std::make_shared<PictureOptions>();
  command->add_option("OUT", options->out, "folder of a run with frames")->required();
  command->add_option("--frame", options->frame, "number of the frame, from 0; -1: the last")->capture_default_str();
  command->add_option("--variant", options->variant, "default: the first");
  command
      ->add_option("--colour,--color", options->colour,
                   "displacement, von_mises, pressure, contact_pressure, s, q, jacobian or tissue; of a run of heat "
                   "temperature (its default), coldest, frozen or dead")
      ->capture_default_str();
  command->add_option("--cut", options->cut, "opens the body there: x=0, y=20mm, z=0.03 (metres)");
  command->add_flag("--flip", options->flip, "takes the other side away");
  command->add_option("--size", options->size, "width and height in pixels")->capture_default_str();
  command->add_option("--range", options->range, "ends of the colour scale, in SI; default: those of what is seen")
      ->expected(2);
  command->add_option("--eye", options->eye, "direction from the body to the eye: x y z")->expected(3);
  command->add_option("--exaggerate", options->exaggerate, "factor of the displacement")->capture_default_str();
  command->add_flag("--bare", options->bare, "without scale, length and time");
  command->add_flag("--no-tools", options->no_tools, "without tools");
  command->add_option("--file", options->file, "file to write, .png, .svg or .pdf; default: OUT/picture.png");
  command->footer(kPictureFooter);
  command->callback([options, &action] { action = [options] { return draw(picture_json(*options)); }; });
}

}  // namespace glisson::app
