// What a material answers to: the relaxation functions, after a step of strain, and the complex moduli, under
// a vibration.
//
//   r_lambda(t)    = sum_k lambda_ela,k exp(-t / tau_k) + lambda_elastic, t > 0;  tau_k = lambda_vis,k /
//   lambda_ela,k lambda'(omega) = sum_k lambda_ela,k (omega tau_k)^2 / (1 + (omega tau_k)^2) + lambda_elastic
//   storage lambda''(omega) = sum_k lambda_ela,k omega tau_k / (1 + (omega tau_k)^2) + omega lambda_viscous
//   loss
//
// and mu likewise. The viscous part of r is lambda_viscous delta(t): at t = 0 only, so it is not in r(t).
//
// Source   Ferry, Viscoelastic Properties of Polymers, 3rd ed., 1980, chapter 3
// Units    moduli [Pa], t [s], omega [rad/s]
// Errors   none; t >= 0, omega >= 0, of a material that Material::validate accepts
#pragma once

#include <optional>

#include "rheo/material.hpp"

namespace rheo {

Moduli relaxation(const Material& material, double t);

struct ComplexModuli {
  Moduli storage;
  Moduli loss;
};

ComplexModuli complex_moduli(const Material& material, double omega);

// One Maxwell branch, of rate 1 / tau [1/s] (0: never relaxes).
double branch_relaxation(double ela, double rate, double t);
double branch_storage(double ela, double rate, double omega);
double branch_loss(double ela, double rate, double omega);

struct Span {
  double shortest = 0.0;
  double longest = 0.0;
};

// The shortest and the longest relaxation time [s] of the branches that are there and relax; empty where none
// does.
std::optional<Span> relaxation_times(const Material& material);

}  // namespace rheo
