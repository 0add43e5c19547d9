"""Text for LaTeX: every character either plain, a command of LaTeX itself, or named by its number.

What comes out compiles with pdfTeX in its standard encoding, whatever the packages: no cell ends a row, is
taken for an argument (a `[` or `*` after `\\\\`), opens mathematics or makes a ligature of its own.
"""

from __future__ import annotations

import unicodedata

from sheetbench.answers.escape import terminal

_MATHS = {
    "−": "-", "×": r"\times", "·": r"\cdot", "±": r"\pm", "≥": r"\ge", "≤": r"\le", "≈": r"\approx",
    "≠": r"\ne", "→": r"\to", "∞": r"\infty", "√": r"\surd", "∂": r"\partial", "∇": r"\nabla",
    "∝": r"\propto", "‖": r"\|", "′": "'", "°": r"^\circ", "½": r"\frac12", "¼": r"\frac14", "¾": r"\frac34",
    "µ": r"\mu", "<": "<", ">": ">", "|": "|",
    "α": r"\alpha", "β": r"\beta", "γ": r"\gamma", "δ": r"\delta", "ε": r"\varepsilon", "ζ": r"\zeta",
    "η": r"\eta", "θ": r"\theta", "ι": r"\iota", "κ": r"\kappa", "λ": r"\lambda", "μ": r"\mu", "ν": r"\nu",
    "ξ": r"\xi", "π": r"\pi", "ρ": r"\rho", "σ": r"\sigma", "τ": r"\tau", "φ": r"\varphi", "χ": r"\chi",
    "ψ": r"\psi", "ω": r"\omega", "Γ": r"\Gamma", "Δ": r"\Delta", "Θ": r"\Theta", "Λ": r"\Lambda",
    "Ξ": r"\Xi", "Π": r"\Pi", "Σ": r"\Sigma", "Φ": r"\Phi", "Ψ": r"\Psi", "Ω": r"\Omega",
    **{sign: f"^{digit}" for sign, digit in zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-", strict=True)},
    **{sign: f"_{digit}" for sign, digit in zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True)},
}  # fmt: skip
_TEXT = {
    "\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}",
    "`": r"\textasciigrave{}", '"': "''", "’": "'", "‘": "`{}", "“": "``{}", "”": "''{}",
    "–": "--", "—": "---", "…": r"\dots{}", "[": "{[}", "]": "{]}", "*": "{*}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
    **{character: f"${command}$" for character, command in _MATHS.items()},
}  # fmt: skip
_LETTERS = "ßøØæÆœŒåÅłŁ"
_ACCENTS = "\u0300\u0301\u0302\u0303\u0304\u0306\u0307\u0308\u030a\u030b\u030c\u0327"


def latex(text: str) -> str:
    """Return the text with what LaTeX reads as its own made plain, on one line."""
    parts = terminal(" ".join(text.split())).split("--")  # which would become a dash
    return "-{}-".join("".join(map(_shown, part)) for part in parts).replace("$$", "${}$")


def _shown(character: str) -> str:
    if character in _TEXT:
        return _TEXT[character]
    if character.isascii() or character in _LETTERS or _accented(character):
        return character
    return f"{{[}}U+{ord(character):04X}{{]}}"


def _accented(character: str) -> bool:
    """Return whether it is a letter with one accent that every encoding of LaTeX can put together."""
    parts = unicodedata.normalize("NFD", character)
    return len(parts) == 2 and parts[0].isascii() and parts[0].isalpha() and parts[1] in _ACCENTS
