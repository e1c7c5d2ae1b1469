#include "io/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "io/material_data.hpp"
#include "io/message.hpp"
#include "io/table_reader.hpp"
#include "rheo/limits.hpp"
#include "rheo/material_presets.hpp"

namespace rheo {
namespace {

using Words = std::vector<std::string>;

constexpr NumberRule modulus{.low = 0.0, .unit = "Pa"};
constexpr NumberRule viscosity{.low = 0.0, .low_allowed = false, .infinite_allowed = true, .unit = "Pa s"};
constexpr NumberRule finite_viscosity{.low = 0.0, .low_allowed = false, .unit = "Pa s"};
constexpr NumberRule parallel_viscosity{.low = 0.0, .unit = "Pa s"};
constexpr NumberRule density{.low = 0.0, .low_allowed = false, .unit = "kg/m^3"};
constexpr NumberRule seconds{.low = 0.0, .low_allowed = false, .unit = "s"};

const Words branch_keys{"lambda_ela", "mu_ela", "lambda_vis", "mu_vis", "young_ela", "young_vis"};
const Words table_keys{"elastic", "viscous", "maxwell"};
const Words data_keys{"relaxation", "frequency"};
const Words fit_keys{"modulus", "terms", "weights"};

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// The keys of one number for lambda and mu each.
struct Names {
  std::string lambda, mu, young;

  static Names of(const std::string& element) {
    return {"lambda_" + element, "mu_" + element, "young_" + element};
  }
};

const Names plain{"lambda", "mu", "young"};

Words names_of(const std::vector<PresetElement>& elements) {
  Words words;
  for (const PresetElement& element : elements) {
    const Names names = Names::of(element.name);
    words.insert(words.end(), {names.lambda, names.mu, names.young});
  }
  return words;
}

// The preset that a table names, where it names one.
const Preset* preset_in(const TomlValue& table) {
  const TomlEntry* entry = table.find("preset");
  return entry == nullptr || entry->value.type != TomlValue::Type::string ? nullptr
                                                                          : find_preset(entry->value.text);
}

// Those of a preset, or of all other ways. The ways that a preset has no use for are named when they are
// refused. Beside a preset that is not known any key: it is the preset that is wrong.
Words keys_of(const TomlValue& table) {
  const Words all =
      Words{"density", "mass", "poisson", "plane", "preset"} + table_keys + data_keys + fit_keys;
  if (const Preset* preset = preset_in(table)) return names_of(preset->elements) + all;
  if (table.find("preset") != nullptr) {
    Words any;
    for (const TomlEntry& entry : table.entries) any.push_back(entry.key);
    return any;
  }
  return Words{"lambda_ela", "mu_ela", "lambda_vis", "mu_vis", "density", "mass"} + branch_keys + all;
}

class MaterialReader {
 public:
  MaterialReader(const TomlValue& table, const std::string& file, Allowance& allowance,
                 const std::string& owner)
      : file_(file),
        allowance_(allowance),
        name_(owner + "material"),
        top_(table, file, fmt::format("[{}]", name_), table.line, keys_of(table)) {}

  MaterialReading read() {
    static const std::array<std::string, 2> planes{"strain", "stress"};
    static const std::array<std::string, 2> masses{"lumped", "consistent"};
    const Preset* const preset = top_.has("preset") ? &known_preset() : nullptr;
    plane_ = static_cast<Plane>(top_.choice("plane", planes, 0));
    const std::string way = chosen_way();
    Material& m = reading_.material;
    if (way.empty())
      read_parts();
    else if (way == "preset")
      read_preset(*preset);
    else
      read_data(way);
    m.density = top_.required_number("density", density, "the density");
    m.mass = static_cast<Mass>(top_.choice("mass", masses, 0));
    refuse_idle_keys();
    top_.locate([&] { m.validate(top_.header()); });
    return std::move(reading_);
  }

 private:
  // preset, relaxation or frequency; empty: lambda and mu of branches and parts.
  std::string chosen_way() const {
    const Words ways = Words{"preset"} + data_keys;
    const auto way = std::find_if(ways.begin(), ways.end(), [&](const auto& key) { return top_.has(key); });
    if (way == ways.end()) return {};
    // A preset's own keys may be named as a branch's are.
    for (const std::string& key : ways + table_keys + (*way == "preset" ? Words{} : branch_keys)) {
      if (key == *way || !top_.has(key)) continue;
      top_.refuse(key, *top_.find(key),
                  fmt::format("{} = {} gives the whole material; leave out one of the two", *way,
                              written(*top_.find(*way))));
    }
    return *way;
  }

  void read_parts() {
    const bool other = top_.has("elastic") || top_.has("viscous") || top_.has("maxwell");
    const bool simple = !other || std::any_of(branch_keys.begin(), branch_keys.end(),
                                              [&](const auto& k) { return top_.has(k); });
    Material& m = reading_.material;
    std::vector<MaxwellBranch> branches;
    if (simple) branches.push_back(branch(top_));
    for (const TomlValue& value : tables_of(top_.find("maxwell"), file_, name_ + ".maxwell")) {
      const TableReader reader(value, file_, fmt::format("[[{}.maxwell]]", name_), value.line,
                               branch_keys + Words{"time", "poisson"});
      refuse_idle_poisson(reader);
      branches.push_back(branch(reader));
    }
    if (!branches.empty()) {
      const MaxwellBranch& first = branches.front();
      m.lambda_ela = first.lambda_ela;
      m.mu_ela = first.mu_ela;
      m.lambda_vis = first.lambda_vis;
      m.mu_vis = first.mu_vis;
      m.more_branches.assign(branches.begin() + 1, branches.end());
    }
    m.elastic = part("elastic", modulus, "modulus");
    m.viscous = part("viscous", parallel_viscosity, "viscosity");
  }

  // A table's own ratio, where it gives no Young's modulus.
  static void refuse_idle_poisson(const TableReader& reader) {
    for (const char* young : {"young", "young_ela", "young_vis"})
      if (reader.has(young)) return;
    if (const TomlValue* value = reader.find("poisson"))
      reader.refuse("poisson", *value, "goes with a young key only; leave it out here");
  }

  MaxwellBranch branch(const TableReader& reader) {
    const Moduli ela = moduli(reader, Names::of("ela"), modulus, "the elastic modulus of the {} branch");
    if (reader.has("time")) return branch_by_time(reader, ela);
    Moduli vis = moduli(reader, Names::of("vis"), viscosity, "the viscous modulus of the {} branch");
    // Poisson's ratio 0: there is no lambda.
    if (vis.lambda == 0.0) {
      if (ela.lambda > 0.0)
        reader.refuse("young_vis", *reader.find("young_vis"),
                      fmt::format("gives lambda_vis = 0, which leaves nothing of lambda_ela = {:g}; give "
                                  "lambda_vis and mu_vis",
                                  ela.lambda));
      vis.lambda = std::numeric_limits<double>::infinity();
    }
    return {ela.lambda, ela.mu, vis.lambda, vis.mu};
  }

  static MaxwellBranch branch_by_time(const TableReader& reader, const Moduli& ela) {
    for (const char* key : {"lambda_vis", "mu_vis", "young_vis"}) {
      if (const TomlValue* value = reader.find(key))
        reader.refuse(key, *value, "time is there too; leave out one of the two");
    }
    const double time = reader.number("time", seconds, 0.0);
    MaxwellBranch b{.lambda_ela = ela.lambda, .mu_ela = ela.mu};
    for (const auto& [modulus_, vis] : {std::pair{ela.lambda, &b.lambda_vis}, {ela.mu, &b.mu_vis}}) {
      if (modulus_ == 0.0) continue;
      *vis = modulus_ * time;
      if (!of_usable_size(*vis))
        reader.refuse("time", *reader.find("time"),
                      fmt::format("gives a viscosity of {:g} Pa s; {:g} to {:g} is allowed", *vis,
                                  smallest_size, largest_size));
    }
    return b;
  }

  Moduli part(const std::string& name, const NumberRule& rule, const char* what) {
    const TomlValue* value = top_.find(name);
    if (value == nullptr) return {};
    if (value->type == TomlValue::Type::array)
      top_.refuse(name, *value, fmt::format("one table, [{}.{}], is needed", name_, name));
    const TableReader reader(*value, file_, fmt::format("[{}.{}]", name_, name), value->line,
                             {"lambda", "mu", "young", "poisson"});
    refuse_idle_poisson(reader);
    return moduli(reader, plain, rule, fmt::format("the {} {} by {{}}", name, what));
  }

  const Preset& known_preset() const {
    const std::string name = top_.text("preset", {});
    if (const Preset* preset = find_preset(name)) return *preset;
    Words known;
    for (const Preset& p : material_presets()) known.push_back(p.name);
    const std::string near = nearest_word(name, known);
    top_.refuse(
        "preset", *top_.find("preset"),
        fmt::format("{}{} is allowed", near.empty() ? "" : fmt::format("did you mean {}? ", in_quotes(near)),
                    word_list(known)));
  }

  void read_preset(const Preset& preset) {
    std::vector<Moduli> values;
    for (const PresetElement& element : preset.elements) values.push_back(element_of(preset, element));
    settle_dashpots(preset, values);
    reading_.material = expanded(preset, values, reading_.material);
    reading_.origin.preset = preset.name;
  }

  Moduli element_of(const Preset& preset, const PresetElement& element) {
    using Kind = PresetElement::Kind;
    const Names names = Names::of(element.name);
    const NumberRule& rule = element.kind == Kind::spring           ? modulus
                             : element.kind == Kind::dashpot        ? viscosity
                             : element.kind == Kind::finite_dashpot ? finite_viscosity
                                                                    : parallel_viscosity;
    return moduli(top_, names, rule,
                  fmt::format("{} of {}, {}, by {{}}", element.name, preset.name, preset.circuit));
  }

  // Poisson's ratio 0: there is no lambda, its springs are 0 and its dashpots any number.
  void settle_dashpots(const Preset& preset, std::vector<Moduli>& values) const {
    const auto is_spring = [&](std::size_t k) {
      return preset.elements[k].kind == PresetElement::Kind::spring;
    };
    bool lambda = false;
    for (std::size_t k = 0; k < values.size(); ++k)
      lambda = lambda || (is_spring(k) && values[k].lambda > 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const bool may_be_zero =
          is_spring(k) || preset.elements[k].kind == PresetElement::Kind::parallel_dashpot;
      if (may_be_zero || values[k].lambda > 0.0) continue;
      const Names names = Names::of(preset.elements[k].name);
      if (lambda)
        top_.refuse(names.young, *top_.find(names.young),
                    fmt::format("gives {0} = 0 beside springs of lambda that are not 0; give {0} and {1}",
                                names.lambda, names.mu));
      values[k].lambda = values[k].mu;
    }
  }

  void read_data(const std::string& way) {
    const TomlValue& value = *top_.find(way);
    MeasuredMaterial measured = read_fit_settings(way, value);
    const std::string name = top_.text(way, {});
    if (name.empty()) top_.refuse(way, value, "the name of a CSV file is needed");
    top_.attribute(way, value, [&] {
      const std::filesystem::path path = allowance_.files.resolve(name);
      fit_data(path, way == "frequency" ? DataKind::sweep : DataKind::relaxation, options_, measured,
               allowance_.memory);
      set_series(measured, reading_.material);
      reading_.files.push_back(path.string());
    });
    if (const std::string note = doubt_about(measured); !note.empty())
      reading_.notes.push_back(fmt::format("{} = {}: {}", way, written(value), note));
    reading_.origin.measured = std::move(measured);
  }

  MeasuredMaterial read_fit_settings(const std::string& way, const TomlValue& value) {
    static const std::array<std::string, 2> kinds{"young", "shear"};
    static const std::array<std::string, 2> weights{"relative", "absolute"};
    MeasuredMaterial measured;
    measured.plane = plane_;
    measured.poisson = poisson(top_, way, value);
    measured.modulus = static_cast<MeasuredModulus>(top_.choice("modulus", kinds, 0));
    measured.weights = options_.weights = static_cast<FitWeights>(top_.choice("weights", weights, 0));
    if (const TomlValue* terms = top_.find("terms"))
      options_.terms = top_.integer("terms", *terms, 1, most_prony_terms, "whole number of branches");
    return measured;
  }

  // lambda and mu, or young with poisson; `meaning` has {} for lambda or mu.
  Moduli moduli(const TableReader& reader, const Names& names, const NumberRule& rule,
                const std::string& meaning) {
    const TomlValue* young = reader.find(names.young);
    if (young == nullptr) {
      const auto number = [&](const std::string& key, const char* which) {
        return reader.required_number(key, rule, fmt::format(fmt::runtime(meaning), which));
      };
      const double lambda = number(names.lambda, "lambda");
      return {lambda, number(names.mu, "mu")};
    }
    for (const std::string& key : {names.lambda, names.mu}) {
      if (const TomlValue* value = reader.find(key))
        reader.refuse(key, *value,
                      fmt::format("{} is there too; {} and {}, or {} with poisson", names.young, names.lambda,
                                  names.mu, names.young));
    }
    MaterialConversion c;
    c.name = fmt::format("{} {}", reader.header(), names.young);
    c.unit = rule.unit;
    c.plane = plane_;
    c.given.young = reader.number(names.young, rule, 0.0);
    c.given.poisson = poisson(reader, names.young, *young);
    c.moduli = moduli_of(c.given, plane_);
    for (const auto& [name, value] : {std::pair{&names.lambda, c.moduli.lambda}, {&names.mu, c.moduli.mu}}) {
      if (value != 0.0 && std::isfinite(value) && !of_usable_size(value))
        reader.refuse(names.young, *young,
                      fmt::format("gives {} = {:g}; {:g} to {:g} is allowed ({})", *name, value,
                                  smallest_size, largest_size, rule.unit));
    }
    reading_.origin.conversions.push_back(c);
    return c.moduli;
  }

  // Of the table, else of [material]; needed for `key`.
  double poisson(const TableReader& reader, const std::string& key, const TomlValue& value) {
    const TableReader& owner = reader.has("poisson") ? reader : top_;
    const TomlValue* found = owner.find("poisson");
    if (found == nullptr) reader.refuse(key, value, "poisson, Poisson's ratio, is needed beside it");
    const bool incompressible = plane_ == Plane::stress;  // may be
    if (!found->is_number() || !(found->number >= 0.0) || !(found->number <= 0.5) ||
        (found->number == 0.5 && !incompressible)) {
      owner.refuse("poisson", *found,
                   incompressible ? "a number >= 0 and <= 0.5 is needed"
                                  : "a number >= 0 and < 0.5 is needed (plane strain: lambda grows beyond "
                                    "bounds at 0.5)");
    }
    const double ratio = found->number;
    if (plane_ == Plane::stress && ratio_ && ratio != *ratio_) {
      owner.refuse(
          "poisson", *found,
          fmt::format("under plane = \"stress\" one ratio for all is needed, and another table has {:g}",
                      *ratio_));
    }
    ratio_ = ratio;
    return ratio;
  }

  // Keys that would mean nothing.
  void refuse_idle_keys() const {
    const auto refuse = [&](const std::string& key, const char* owner) {
      if (const TomlValue* value = top_.find(key))
        top_.refuse(key, *value, fmt::format("goes with {} only; leave it out here", owner));
    };
    if (!ratio_) {
      for (const char* key : {"poisson", "plane"}) refuse(key, "a young key or measured data");
    }
    if (!reading_.origin.measured) {
      for (const std::string& key : fit_keys) refuse(key, "relaxation or frequency");
    }
  }

  const std::string& file_;
  Allowance& allowance_;
  std::string name_;  // "material", "body.material"
  TableReader top_;
  Plane plane_ = Plane::strain;
  std::optional<double> ratio_;  // the last that was used
  PronyOptions options_;
  MaterialReading reading_;
};

}  // namespace

MaterialReading read_material(const TomlValue& table, const std::string& file, Allowance& allowance,
                              const std::string& owner) {
  return MaterialReader(table, file, allowance, owner).read();
}

}  // namespace rheo
