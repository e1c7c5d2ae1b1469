// What Ui does when it is told to, by a key or a button.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rheo/error.hpp"
#include "rheo/io/scene_text.hpp"
#include "state_hash.hpp"
#include "view/ui.hpp"

namespace app::view {
namespace {

// A session has an output a tick: some 50 frames a second of them.
int session_every(double ticks_a_second) {
  return std::max(1, static_cast<int>(std::lround(ticks_a_second / 50.0)));
}

}  // namespace

void Ui::run() {
  if (recording_.is_on())
    recording_runs_ = true;
  else
    physics_.run();
}

void Ui::pause() {
  if (recording_.is_on())
    recording_runs_ = false;
  else
    physics_.pause();
}

void Ui::run_or_pause() {
  if (recording_.is_on())
    recording_runs_ = !recording_runs_;
  else
    physics_.run_or_pause();
}

bool Ui::is_running() const {
  return recording_.is_on() ? recording_runs_ : display_->running;
}

void Ui::step() {
  if (recording_.is_on() && recording_runs_)
    return say("the recording takes its own steps: Space lets it wait, then . takes one");
  if (recording_.is_on()) ++asked_ticks_;
  physics_.step(1);
}

void Ui::set_speed(double speed) {
  speed_ = std::clamp(speed, slowest, fastest);
  physics_.set_speed(speed_);
}

void Ui::load(const std::filesystem::path& file) {
  end_hand();
  physics_.forget_steps();
  say(fmt::format("loading {}", file.string()));
  physics_.post([read = settings_.read, file](Core& core) {
    try {
      core.say({});
      if (core.load(read(file)) && core.message().empty())
        core.say(fmt::format("loaded {}", file.filename().string()));
    } catch (const std::exception& error) {
      core.say(error.what());
    }
  });
}

void Ui::save_session() {
  // As it is seen now, so that rheo render shows the same.
  rheo::PictureSettings seen = display_->scene->picture;
  seen.color = style_.color;
  seen.size = {area_[2], area_[3]};
  seen.bounds = picture_.bounds();
  seen.arrow_scale = picture_.arrow_scale();
  seen.range_auto = !(picture_.range()[0] < picture_.range()[1]);
  if (!seen.range_auto) seen.range = picture_.range();
  physics_.post([folder = settings_.folder, seen](Core& core) {
    if (auto scene = core.session()) {
      scene->picture.color = seen.color;
      scene->picture.size = seen.size;
      scene->picture.bounds = seen.bounds;
      scene->picture.arrow_scale = seen.arrow_scale;
      scene->picture.range_auto = seen.range_auto;
      scene->picture.range = seen.range;
      scene->picture.every = session_every(core.rate());
      const std::string hash = state_hash(core.live().simulation());
      try {
        core.say(Recording(folder).text_file(
            "session", ".toml",
            "# state at its end, as state_hash in run.json: " + hash + "\n" + rheo::scene_text(*scene)));
      } catch (const std::exception& error) {
        core.say(error.what());
      }
    }
  });
}

void Ui::save_picture(Saved what) {
  render::Image image;
  if (what == Saved::window)
    screen_.read(image);
  else
    picture_.read(image);
  say(recording_.picture(image));
}

void Ui::take_keys(const Input& input) {
  std::vector<char> down(key_count, 0);
  for (const Key key : input.down) down[static_cast<std::size_t>(key)] = 1;
  const With held = input.control ? With::control : input.shift ? With::shift : With::nothing;
  for (const Key key : input.down) {
    if (was_down_[static_cast<std::size_t>(key)] != 0 || ImGui::GetIO().WantTextInput) continue;
    if (const auto action = action_of(key, held)) act(*action);
  }
  was_down_ = std::move(down);
}

void Ui::act(Action action) {
  switch (action) {
    case Action::run_or_pause:
      return run_or_pause();
    case Action::one_tick:
      return step();
    case Action::reset:
      reset();
      return pause();
    case Action::restart:
      reset();
      return run();
    case Action::fit:
      return picture_.fit();
    case Action::push_or_grab:
      if (!dragging_) mode_ = mode_ == Hold::push ? Hold::grab : Hold::push;
      return;
    case Action::mesh_lines:
      style_.mesh_lines = !style_.mesh_lines;
      return;
    case Action::rest_shape:
      style_.rest_shape = !style_.rest_shape;
      return;
    case Action::node_numbers:
      style_.node_numbers = !style_.node_numbers;
      return;
    case Action::dark:
      style_.dark = !style_.dark;
      return;
    case Action::next_colour:
      return choose_colour(static_cast<rheo::ColorBy>((static_cast<int>(style_.color) + 1) % 5));
    case Action::plots:
      plots_ = !plots_;
      return;
    case Action::panels:
      panels_ = plots_ = !(panels_ || plots_);
      return;
    case Action::help:
      help_ = !help_;
      return;
    case Action::close_help:
      help_ = false;
      return;
    case Action::faster:
      return set_speed(speed_ * 2.0);
    case Action::slower:
      return set_speed(speed_ / 2.0);
    case Action::real_time:
      return set_speed(1.0);
    case Action::smaller_brush:
      brush_ = std::max(smallest_brush, brush_ / 1.3f);
      return;
    case Action::larger_brush:
      brush_ = std::min(largest_brush, brush_ * 1.3f);
      return;
    case Action::save_picture:
      return save_picture(Saved::picture);
    case Action::save_window:
      return save_picture(Saved::window);
    case Action::record:
      return toggle_recording();
    case Action::save_session:
      return save_session();
    case Action::quit:
      quit_ = true;
      return;
  }
}

void Ui::reset() {
  end_hand();
  physics_.forget_steps();
  physics_.post([](Core& core) { core.reset(); });
}

}  // namespace app::view
