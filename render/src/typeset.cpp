#include "typeset.hpp"

#include <array>
#include <cctype>
#include <utility>

namespace render {
namespace {

using Letter = std::pair<std::string_view, std::string_view>;
constexpr std::array<Letter, 17> greek{{{"alpha", "α"},
                                        {"beta", "β"},
                                        {"gamma", "γ"},
                                        {"delta", "δ"},
                                        {"epsilon", "ε"},
                                        {"eta", "η"},
                                        {"theta", "θ"},
                                        {"kappa", "κ"},
                                        {"lambda", "λ"},
                                        {"mu", "μ"},
                                        {"nu", "ν"},
                                        {"rho", "ρ"},
                                        {"sigma", "σ"},
                                        {"tau", "τ"},
                                        {"phi", "φ"},
                                        {"psi", "ψ"},
                                        {"omega", "ω"}}};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

// `text` with the words that name Greek letters replaced.
std::string with_greek(std::string_view text) {
  std::string out;
  std::size_t i = 0;
  while (i < text.size()) {
    std::size_t end = i;
    while (end < text.size() && is_word(text[end])) ++end;
    if (end == i) {
      out += text[i++];
      continue;
    }
    std::string_view word = text.substr(i, end - i);
    for (const Letter& letter : greek) {
      if (word == letter.first) word = letter.second;
    }
    out += word;
    i = end;
  }
  return out;
}

}  // namespace

std::string_view typeset_characters() {
  return "αβγδεηθκλμνρστφψω−×·°…";
}

std::vector<Run> typeset(std::string_view label) {
  std::vector<Run> runs;
  std::string base;
  const auto flush = [&] {
    if (!base.empty()) runs.push_back({with_greek(base), Level::base});
    base.clear();
  };
  std::size_t i = 0;
  while (i < label.size()) {
    const char c = label[i];
    const bool mark = (c == '_' || c == '^') && i > 0 && label[i - 1] != ' ' && i + 1 < label.size();
    std::size_t begin = i + 1, end = begin;
    if (mark && label[begin] == '{') {
      end = label.find('}', ++begin);
      if (end == std::string_view::npos) end = begin;
    } else if (mark) {
      if (c == '^' && (label[end] == '-' || label[end] == '+')) ++end;
      while (end < label.size() && is_word(label[end])) ++end;
    }
    if (!mark || end == begin) {
      base += c;
      ++i;
      continue;
    }
    flush();
    std::string text = with_greek(label.substr(begin, end - begin));
    if (text.front() == '-') text.replace(0, 1, "−");
    runs.push_back({std::move(text), c == '_' ? Level::lower : Level::raised});
    i = end < label.size() && label[end] == '}' ? end + 1 : end;
  }
  flush();
  return runs;
}

}  // namespace render
