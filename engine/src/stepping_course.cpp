// What a Stepping carries from call to call beside the state, as bytes and back: Snapshot::course.
//
// Left out is what follows from the scene and the time: the interval, solvers, factors, expansions.
#include "rheo/error.hpp"
#include "rheo/io/bytes.hpp"
#include "stepping.hpp"

namespace rheo {

void Stepping::put_course(ByteWriter& out) {
  out.put(static_cast<std::uint64_t>(index_));
  out.put(interval_.begin);
  out.put(time_);
  out.put(largest_step_);
  out.put(book_);
  out.put(begun_);
  out.put(static_cast<std::uint64_t>(resting_ ? 1 : 0));
  out.put(steps_since_look_);
  out.put_list(allowed_violation_);
  out.put(cancelled_way_);
  out.put(static_cast<std::int64_t>(excuses_));
  rest_.put(out);
  holds_.put(out);
  out.put_list(body_.state().first(body_.inexact_size()));
  readings_.put(out);
  out.put(static_cast<std::uint64_t>(body_.known_rate().empty() ? 0 : 1));
  out.put(body_.counters());
  out.put_list(integrator_.memory());
}

void Stepping::get_course(ByteReader& in, std::span<const double> y) {
  const auto index = static_cast<std::size_t>(in.get<std::uint64_t>());
  if (index >= schedule_.interval_count())
    throw Error(Error::Kind::input, "lies beyond this scene's events: it is another scene's");
  index_ = index;
  schedule_.fill(index_, in.get<double>(), interval_);
  time_ = in.get<double>();
  largest_step_ = in.get<double>();
  book_ = in.get<EnergyBook>();
  begun_ = in.get<Begun>();
  resting_ = in.get<std::uint64_t>() != 0;
  steps_since_look_ = in.get<std::int64_t>();
  allowed_violation_ = in.get_list<double>();
  if (!allowed_violation_.empty() && allowed_violation_.size() != interval_.solver->columns().size())
    throw Error(Error::Kind::input, "has other constraints than this scene: it is another scene's");
  cancelled_way_ = in.get<double>();
  excuses_ = static_cast<int>(in.get<std::int64_t>());
  rest_.get(in);
  holds_.get(in);
  entered_ = true;
  diverged_.reset();

  // As passing the event did; what it imposed is in the state already, and all of that comes after.
  body_.enter(interval_, holds_.base());
  body_.impose_prescribed(time_);
  body_.load(y);
  in.get_list(body_.state().first(body_.inexact_size()));
  readings_.get(in);
  if (in.get<std::uint64_t>() != 0) body_.know_rate(time_);
  body_.counters() = in.get<Counters>();
  const std::vector<double> memory = in.get_list<double>();
  if (memory.size() != integrator_.memory().size())
    throw Error(Error::Kind::input, "is another integrator's: name that one");
  integrator_.remember(memory);
}

}  // namespace rheo
