// All that can be pressed in the window is pressed.
#include "view/widgets.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "draw_or_skip.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

// Somebody who presses whatever there is, once.
class Explorer {
 public:
  explicit Explorer(Driver& user) : user_(user) { frame(); }

  std::set<std::string> all, reached;
  std::set<std::string> doubles;  // names that two widgets of one frame had

  // `name`, and what the physics' next whole state shows for it, which a slow machine takes some frames for.
  void press(const std::string& name, const std::string& shown_then) {
    click(name);
    for (int k = 0; k < 1000 && user_.widget(shown_then) == nullptr; ++k) frame();
    click(shown_then);
  }

  // Of those whose names pass.
  void press_all(const std::function<bool(const std::string&)>& pass) {
    for (int tries = 0; tries < 1000; ++tries) {
      const std::string next = choose(pass);
      if (next.empty()) return;
      const std::set<std::string> before = unreached_here();
      click(next);
      ++tried_[next];
      // What closed and hides something new is opened again.
      bool hides = false;
      const std::set<std::string> after = unreached_here();
      for (const std::string& name : before)
        hides = hides || (!after.contains(name) && !reached.contains(name));
      if (hides && user_.widget(next) != nullptr && !is_list_item(next)) click(next);
    }
  }

 private:
  static bool is_list_item(const std::string& name) { return name.find(": ") != std::string::npos; }

  void look() {
    std::set<std::string> here;
    for (const auto& seen : user_.ui.widgets()) {
      if (!here.insert(seen.name).second) doubles.insert(seen.name);
      all.insert(seen.name);
      if (seen.active) reached.insert(seen.name);
    }
  }
  void frame() {
    user_.frame();
    look();
  }
  std::set<std::string> unreached_here() const {
    std::set<std::string> names;
    for (const auto& seen : user_.ui.widgets())
      if (!reached.contains(seen.name)) names.insert(seen.name);
    return names;
  }
  bool is_under_cursor(const std::string& name) const {
    const auto* widget = user_.widget(name);
    const auto& [x, y] = user_.input.cursor;
    return widget != nullptr && widget->x0 <= x && x <= widget->x1 && widget->y0 <= y && y <= widget->y1;
  }
  // Once more where it was moved away under the button held down, by a line that came or went above it.
  void click(const std::string& name) {
    for (int k = 0; k < 3; ++k) {
      const auto* widget = user_.widget(name);
      if (widget == nullptr) return;
      user_.input.cursor = {widget->x0 + std::min(10.0f, (widget->x1 - widget->x0) / 2),
                            (widget->y0 + widget->y1) / 2};
      frame();
      user_.input.buttons[0] = true;
      frame();
      const bool held = is_under_cursor(name);
      user_.input.buttons[0] = false;
      frame();
      frame();
      if (held) return;
    }
  }
  // A list's items while it is open, then what lies over the rest, then from the top.
  std::string choose(const std::function<bool(const std::string&)>& pass) {
    std::string next;
    for (const auto& seen : user_.ui.widgets()) {
      if (!pass(seen.name)) continue;
      if (reached.contains(seen.name) || tried_[seen.name] > 2) continue;
      if (is_list_item(seen.name) || seen.name == "Close") return seen.name;
      if (next.empty()) next = seen.name;
    }
    for (const std::string& name : all) {  // lists have closed with their first item
      const std::string list = name.substr(0, name.rfind(": "));
      if (!reached.contains(name) && is_list_item(name) && user_.widget(list) != nullptr &&
          opened_[list]++ < 20)
        return list;
    }
    return next;
  }

  Driver& user_;
  std::map<std::string, int> tried_, opened_;
};

rheo::Scene scene_with_everything() {
  rheo::Scene scene = block();
  rheo::Traction& load = scene.tractions.emplace_back();
  load.edges = scene.mesh.edge_groups.at("top");
  load.keys = {{0.0, {0, -20}}};
  scene.material.more_branches.push_back({100, 50, 20, 10});
  scene.material.elastic = {200, 100};
  scene.material.viscous = {1, 1};
  scene.material_name = "flesh";
  rheo::Region& lump = scene.regions.emplace_back();
  lump.name = "lump";
  lump.material = block().material;
  scene.region_of_triangle.assign(scene.mesh.triangles.size(), 0);
  scene.region_of_triangle.back() = 1;
  return scene;
}

TEST(ViewWidgets, EveryOneIsReachedAndHarmless) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  fs::create_directories(folder / "scenes");
  fs::copy_file(fs::path(RHEO_SOURCE_DIR) / "app/scenes/beam.toml", folder / "scenes/beam.toml");
  std::ofstream(folder / "scenes/broken.toml") << "[mesh]\nshape = 7\n";
  app::view::UiSettings settings = Driver::settings(folder, {});
  settings.scene = folder / "scenes/beam.toml";
  Driver user(*context, scene_with_everything(), std::move(settings));
  user.input.width = 1200;
  user.frames(3);
  Explorer explorer(user);
  explorer.press_all([](const std::string& name) { return name.size() == 1 || name == "|w|"; });  // the plots
  EXPECT_EQ(explorer.reached.size(), 4u);
  user.key(key_of('P'));  // the rest on a high panel, in little room for a picture
  user.input.width = 760;
  user.input.height = 2300;
  user.frames(2);
  explorer.press("material 1, flesh/Add a branch", "material 1, flesh/branch 3");
  explorer.press("broken.toml", "broken.toml");
  explorer.press("Help", "Close");
  explorer.press_all([](const std::string&) { return true; });
  // The list of scenes came last of all sections, so that the first body's own widgets were all there.
  std::set<std::string> missed;
  std::ranges::set_difference(explorer.all, explorer.reached, std::inserter(missed, missed.end()));
  EXPECT_THAT(missed, testing::IsEmpty()) << "seen, but never took the mouse";
  EXPECT_THAT(explorer.doubles, testing::IsEmpty());
  for (const char* name : {"Run",
                           "Pause",
                           "Step",
                           "Reset",
                           "Restart",
                           "Help",
                           "Close",
                           "speed",
                           "Hand",
                           "push",
                           "grab",
                           "brush",
                           "strength",
                           "Picture",
                           "colour",
                           "colour: speed",
                           "auto",
                           "held",
                           "typed",
                           "low, high x",
                           "low, high y",
                           "mesh",
                           "rest shape",
                           "nodes",
                           "dark",
                           "Material",
                           "material 1, flesh",
                           "material 1, flesh/lambda_ela",
                           "material 1, flesh/mu_ela",
                           "material 1, flesh/lambda_vis",
                           "material 1, flesh/mu_vis",
                           "material 1, flesh/lambda relaxes",
                           "material 1, flesh/mu relaxes",
                           "material 1, flesh/density",
                           "material 1, flesh/elastic lambda",
                           "material 1, flesh/elastic mu",
                           "material 1, flesh/viscous lambda",
                           "material 1, flesh/viscous mu",
                           "material 1, flesh/branch 2",
                           "material 1, flesh/branch 2/mu_vis",
                           "material 1, flesh/branch 2/mu relaxes",
                           "material 1, flesh/branch 3",
                           "material 1, flesh/Add a branch",
                           "material 1, flesh/Remove the last",
                           "material 2, lump",
                           "material 2, lump/density",
                           "material 2, lump/Add a branch",
                           "Loads",
                           "m/s² x",
                           "m/s² y",
                           "Pa, load 1 x",
                           "Integration",
                           "integrator",
                           "integrator: implicit",
                           "automatic step",
                           "step",
                           "omega",
                           "Scenes and files",
                           "beam.toml",
                           "broken.toml",
                           "Save session",
                           "Save picture",
                           "|w|",
                           "E",
                           "u",
                           "F"})
    EXPECT_TRUE(explorer.reached.contains(name)) << name;
  EXPECT_TRUE(fs::exists(folder / "picture_001.png"));
  EXPECT_TRUE(user.ticks(5));
  const auto finite = [](double x) { return std::isfinite(x); };
  EXPECT_TRUE(std::ranges::all_of(user.ui.shown().positions, finite));
  EXPECT_TRUE(std::ranges::all_of(user.ui.shown().w_lambda, finite));
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// What can be pressed is made in widgets.cpp alone, and each function there notes it: with the test above, no
// widget of the window is left out.
TEST(ViewWidgets, NoneIsDrawnThatIsNotNoted) {
  const std::regex pressable(
      "ImGui::(Button|SmallButton|InvisibleButton|ArrowButton|ImageButton|Checkbox\\w*|RadioButton|Combo|"
      "BeginCombo|Drag\\w+|Slider\\w+|VSlider\\w+|Input\\w+|Color(Edit|Picker|Button)\\w*|TreeNode\\w*|"
      "CollapsingHeader|Selectable|ListBox|BeginListBox|BeginMenu\\w*|MenuItem|BeginTab\\w*|TabItem\\w*|"
      "BeginTable|BeginPopup\\w*|OpenPopup\\w*)\\(");
  const fs::path sources = fs::path(RHEO_SOURCE_DIR) / "app/src/view";
  int files = 0;
  for (const auto& entry : fs::directory_iterator(sources)) {
    if (entry.path().filename() == "widgets.cpp") continue;
    ++files;
    const std::string text = text_of(entry.path());
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, pressable)) << entry.path().filename() << ": " << found.str();
  }
  EXPECT_GT(files, 20);
  std::string function;
  std::istringstream lines(text_of(sources / "widgets.cpp"));
  int drawing = 0;
  for (std::string line; std::getline(lines, line);) {
    function += line + "\n";
    if (line != "}") continue;
    if (std::regex_search(function, pressable)) {
      ++drawing;
      EXPECT_TRUE(function.find("  note(") != std::string::npos ||
                  function.find("BeginDisabled") != std::string::npos)
          << function;
    }
    function.clear();
  }
  EXPECT_GE(drawing, 9);
}

TEST(ViewWidgets, GrowWithTheWindow) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  const auto height = [&](int w, int h) {
    user.input.width = w;
    user.input.height = h;
    user.frames(3);
    const auto* widget = user.widget("speed");
    return widget == nullptr ? 0.0f : widget->y1 - widget->y0;
  };
  const float usual = height(1280, 720);
  ASSERT_GT(usual, 10.0f);
  EXPECT_NEAR(height(2560, 1440), 2.0f * usual, 2.0f);
  EXPECT_NEAR(height(1920, 1080), 1.5f * usual, 2.0f);
  EXPECT_EQ(height(2560, 720), usual);
  EXPECT_EQ(height(800, 600), usual);
  EXPECT_EQ(height(300, 200), 0.0f);
  EXPECT_EQ(app::view::interface_scale(2.0f, 2560, 1440), 2.0f) << "a display's own scale is not taken twice";
  EXPECT_EQ(app::view::interface_scale(1.0f, 20000, 12000), 4.0f);
}

}  // namespace
}  // namespace view_tests
