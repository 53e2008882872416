#include "tests/hidden/write_case.hpp"

#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/hidden/case_setup.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;

std::string aux_tag(Index aux) { return "aux" + std::to_string(aux + 1); }

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + path.string());
}

/// The plant's file, with the aux signals in it.
std::string unit_text(const HiddenCase& hidden) {
  std::ifstream in(plant_path(hidden.request.plant), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (hidden.data.aux.cols() == 0) return text;
  std::string aux = "  aux:\n";
  for (Index i = 0; i < hidden.data.aux.cols(); ++i) aux += "    - {tag: " + aux_tag(i) + "}\n";
  const std::string next = "\nmodel:\n";
  const std::size_t at = text.find(next);
  if (at == std::string::npos) throw std::runtime_error(hidden.request.plant + ": no model");
  return text.insert(at + 1, aux);
}

std::string rows_text(const HiddenCase& hidden, const config::UnitConfig& unit) {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "time";
  for (const std::string& tag : unit.input_tags()) out << ',' << tag;
  for (const std::string& tag : unit.cv_tags()) out << ',' << tag;
  for (Index i = 0; i < hidden.data.aux.cols(); ++i) out << ',' << aux_tag(i);
  for (Index k = 0; k < hidden.data.samples(); ++k) {
    out << '\n' << hidden.data.start_s + static_cast<double>(k) * hidden.data.sample_time_s;
    for (const Eigen::MatrixXd* part : {&hidden.data.inputs, &hidden.data.cvs, &hidden.data.aux})
      for (Index i = 0; i < part->cols(); ++i) out << ',' << (*part)(k, i);
  }
  out << '\n';
  return out.str();
}

std::string truth_text(const HiddenCase& hidden, const config::UnitConfig& unit) {
  const auto tag = [](const std::vector<std::string>& tags, int at) {
    return at < 0 ? nlohmann::ordered_json(nullptr)
                  : nlohmann::ordered_json(tags[static_cast<std::size_t>(at)]);
  };
  nlohmann::ordered_json effects = nlohmann::ordered_json::array();
  for (const TrueEffect& effect : hidden.truth)
    effects.push_back({{"cause", effect.cause ? effect.cause->name().text : "unnamed"},
                       {"kind", effect.cause ? effect.cause->kind() : effect.manner},
                       {"cv", tag(unit.cv_tags(), effect.place.cv)},
                       {"mv", tag(unit.input_tags(), effect.place.input)}});
  const nlohmann::ordered_json truth = {{"class", name_of(hidden.request.effect_class)},
                                        {"seed", hidden.request.seed},
                                        {"effects", effects}};
  return truth.dump() + '\n';
}

}  // namespace

void write_case(const HiddenCase& hidden, const std::filesystem::path& folder) {
  const config::UnitConfig unit = load_plant(hidden.request.plant);
  std::filesystem::create_directories(folder);
  const std::string name = std::string(name_of(hidden.request.effect_class)) + '_' +
                           hidden.request.plant + '_' + std::to_string(hidden.request.seed);
  write(folder / (name + ".csv"), rows_text(hidden, unit));
  write(folder / (name + ".yaml"), unit_text(hidden));
  write(folder / (name + ".json"), truth_text(hidden, unit));
}

}  // namespace mpm::hidden
