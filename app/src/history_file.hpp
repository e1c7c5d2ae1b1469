// history.csv: one row per output.
//
//   t,w_lambda_norm,w_mu_norm,u_max,kinetic,stored,dissipated,work, then NAME_ux,NAME_uy,NAME_fx,NAME_fy per
//   probe
//
// Norms are Euclidean over all nodes, u_max is the largest |u| of a node.
// Units    s, Pa m, m, J, N
// Errors   Failure(file)
#pragma once

#include <vector>

#include "growing_file.hpp"
#include "output_sink.hpp"

namespace app {

class HistoryFile : public OutputSink {
 public:
  HistoryFile(const std::filesystem::path& file, const rheo::Scene& scene);
  // Goes on with the rows that were kept.
  HistoryFile(const std::filesystem::path& file, const GrowingFile::Mark& kept);

  void record(rheo::Simulation& simulation, std::int64_t k) override;
  GrowingFile::Mark keep() { return file_.keep(); }
  // The file appears; without it nothing does.
  void commit() { file_.commit(); }

  // The columns that residual.png plots.
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& w_lambda_norms() const { return w_lambda_norms_; }
  const std::vector<double>& w_mu_norms() const { return w_mu_norms_; }

 private:
  void see(std::string_view row);

  std::vector<double> times_, w_lambda_norms_, w_mu_norms_;
  GrowingFile file_;
};

}  // namespace app
