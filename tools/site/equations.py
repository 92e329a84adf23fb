"""Equations of docs/theory, which are plain text, as MathML: set by the browser, without scripts or fonts.

A line such as "f_s = F D G(l, v)/(4 (n.l)(n.v))     (5)" keeps its order and its slashes, so that it cannot come to
mean something else; names become symbols, ^ and _ what they stand for.
"""
from __future__ import annotations

import html
import re

GREEK = {name: chr(code) for code, name in enumerate(
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho sigma_ sigma tau "
    "upsilon phi chi psi omega".split(), 0x3B1)} | {"PI": "Π"}
FUNCTIONS = set("sin cos tan exp erf acos atan2 max min conj Re Im var cn sn am R1 R3".split())
BIG = {"int": "∫", "sum": "∑"}
SIGNS = {"->": "→", "<-": "←", ">=": "≥", "<=": "≤", "~": "∼", "-": "−", "...": "…"}
TOKEN = re.compile(r"""(?P<space>\s+)|(?P<word>(?!int_|sum_|max_)[a-z]{3,}(?:_[a-z]{3,})+|[a-z]{3,}-[a-z]{3,}|[A-Z][a-z]+'s)
                       |(?P<number>\d+(?:\.\d+)?(?:e-?\d+)?|\.\d+)|(?P<name>[A-Za-z]+\d*'*)
                       |(?P<sign>->|<-|>=|<=|\+=|\.\.\.|.)""", re.VERBOSE)


class _Line:
    """Tokens of a line, and where one is in it."""

    def __init__(self, text: str) -> None:
        self.tokens = [(str(m.lastgroup), m.group()) for m in TOKEN.finditer(text.strip())]
        self.at = 0

    def peek(self, offset: int = 0) -> tuple[str, str]:
        k = self.at + offset
        return self.tokens[k] if 0 <= k < len(self.tokens) else ("end", "")

    def next(self) -> tuple[str, str]:
        self.at += 1
        return self.peek(-1)


def _symbol(name: str) -> str:
    """A name without its script: letter, digits, primes."""
    match = re.fullmatch(r"([A-Za-z]+?)(\d*)('*)", name)
    assert match is not None
    letters, digits, primes = match.groups()
    bar = letters.endswith("bar") and len(letters) > 3
    letters = letters.removesuffix("bar") if bar else letters
    differential = re.fullmatch(rf"d([A-Za-z]|{'|'.join(GREEK)})", letters)
    if letters in GREEK:
        out = f"<mi>{GREEK[letters]}</mi>"
    elif differential and letters not in FUNCTIONS:
        inner = differential.group(1)
        out = f"<mi mathvariant='normal'>d</mi><mi>{GREEK.get(inner, inner)}</mi>"
    else:
        out = f"<mi>{letters}</mi>"
    if bar:
        out = f"<mover><mrow>{out}</mrow><mo>¯</mo></mover>"
    if digits:
        out = f"<msub><mrow>{out}</mrow><mn>{digits}</mn></msub>"
    if primes:
        out = f"<msup><mrow>{out}</mrow><mo>{'′' * len(primes)}</mo></msup>"
    return out


def _is_word(name: str) -> bool:
    letters = name.rstrip("'0123456789")
    known = letters in GREEK or letters in FUNCTIONS or letters in BIG or letters == "sqrt"
    if letters in ("of", "an", "at", "in"):
        return True
    is_differential = letters[0] == "d" and (len(letters) == 2 or letters[1:] in GREEK)
    return (len(letters) > 2 and letters.islower() and not known and not is_differential
            and not letters.endswith("bar"))


def _script(line: _Line) -> str:
    """What follows ^ or _: a number, a name or a group in parentheses, which lose these."""
    sign = ""
    if line.peek() == ("sign", "-") and line.peek(1)[0] in ("name", "number"):
        line.next()
        sign = "<mo>−</mo>"
    kind, text = line.next()
    if kind == "sign" and text in "+-" and not sign:
        return f"<mo>{SIGNS.get(text, text)}</mo>"  # T_+
    if text == "(":
        return sign + _row(line, ")")
    if kind == "number":
        return f"{sign}<mn>{text}</mn>" + (_symbol(line.next()[1]) if line.peek()[0] == "name" else "")
    return sign + _symbol(text)


def _subscript(line: _Line) -> str:
    out = _script(line)
    while line.peek() == ("sign", ",") and line.peek(1)[0] == "name":  # c_b,ij
        line.next()
        out += "<mo separator='true'>,</mo>" + _script(line)
    return out


def _scripts(line: _Line, base: str) -> str:
    below = above = ""
    while line.peek()[1] in ("_", "^"):
        if line.next()[1] == "_":
            below = _subscript(line)
        else:
            above = _script(line)
    if below and above:
        return f"<msubsup><mrow>{base}</mrow><mrow>{below}</mrow><mrow>{above}</mrow></msubsup>"
    if below or above:
        tag = "msub" if below else "msup"
        return f"<{tag}><mrow>{base}</mrow><mrow>{below or above}</mrow></{tag}>"
    return base


def _words(line: _Line, words: str) -> str:
    before = "\u2002" if line.peek(-2)[0] == "space" else ""
    while line.peek()[0] == "space" and (line.peek(1)[0] == "word" or (
            line.peek(1)[0] == "name" and _is_word(line.peek(1)[1]))):
        line.next()
        words += "\u00a0" + line.next()[1]
    after = "\u2002" if line.peek()[0] == "space" else ""
    return _scripts(line, f"<mtext>{before}{words}{after}</mtext>")


def _name(line: _Line, name: str) -> str:
    if name == "sqrt" and line.peek()[1] == "(":
        line.next()
        return _scripts(line, f"<msqrt>{_row(line, ')')}</msqrt>")
    if name in BIG:
        return _scripts(line, f"<mo largeop='true'>{BIG[name]}</mo>")
    if name in FUNCTIONS or (name == "dn" and line.peek(1)[1] == "u"):
        applied = "<mo>&#x2061;</mo>" + ("<mspace width='0.17em'/>" if line.peek()[0] == "space" else "")
        return _scripts(line, f"<mi>{name}</mi>" if len(name) > 1 else f"<mi mathvariant='normal'>{name}</mi>") + applied
    if _is_word(name):
        return _words(line, name)
    return _scripts(line, _symbol(name))


def _is_cross(line: _Line) -> bool:
    """The x of a x b, which has operands on both sides and blanks between."""
    before, after = line.peek(-3), line.peek(1)
    return (line.peek(-2)[0] == "space" and line.peek()[0] == "space" and line.peek(-3)[1] != "×"
            and (before[0] == "name" or before[1] in ")|") and (after[0] == "name" or after[1] in "(|"))


def _sign(line: _Line, sign: str) -> str:
    if sign == "." and (line.peek()[0] == "name" or line.peek()[1] in ("(", "-")):
        return "<mo>·</mo>"
    if sign == "<" and line.peek()[0] != "space":
        return "<mo stretchy='false'>⟨</mo>"
    if sign == ">" and line.peek(-2)[0] != "space":
        return _scripts(line, "<mo stretchy='false'>⟩</mo>")
    if sign == ")":
        return _scripts(line, "<mo stretchy='false'>)</mo>")
    if sign == "|":
        return _scripts(line, "<mo stretchy='false' lspace='0' rspace='0'>|</mo>")
    stretch = " stretchy='false'" if sign in "([])" else ""
    k = -2 if line.peek(-2)[0] != "space" else -3
    if sign == "-" and (line.at < 2 or line.peek(k)[1] in ("(", ",", "=", "->", "end")):
        return "<mo form='prefix' lspace='0' rspace='0'>−</mo>"
    return f"<mo{stretch}>{html.escape(SIGNS.get(sign, sign))}</mo>"


def _is_product(line: _Line, kind: str) -> bool:
    """Names beside each other, with a blank that is to be seen."""
    after, operand = line.peek(1), ("name", "number")
    if kind not in operand or line.peek(-1)[1] == "×" or line.peek()[0] != "space" or after[0] not in operand:
        return False
    return not (after[1] == "x" and line.peek(2)[0] == "space" and line.peek(3)[0] in (*operand, "sign"))


def _row(line: _Line, end: str = "") -> str:
    """MathML up to a closing parenthesis, or the end."""
    out, depth = "", 0
    while line.peek()[0] != "end":
        kind, text = line.next()
        if text == end and depth == 0:
            break
        depth += (text == "(") - (text == ")")
        if kind == "space":
            continue
        if kind == "number":
            mantissa, _, power = text.partition("e")
            out += _scripts(line, f"<mn>{mantissa}</mn>")
            out += f"<mo>×</mo><msup><mn>10</mn><mn>{power.replace('-', '−')}</mn></msup>" if power else ""
        elif text == "x" and _is_cross(line):
            line.tokens[line.at - 1] = ("sign", "×")
            out += "<mo>×</mo>"
        elif kind == "word":
            out += _words(line, text)
        elif kind == "name":
            out += _name(line, text)
        else:
            out += _sign(line, text)
        if _is_product(line, kind):
            out += "<mspace width='0.2em'/>"
    return out


def mathml(text: str) -> str:
    """One equation."""
    return f"<math display='inline'><mrow>{_row(_Line(text))}</mrow></math>"


def _html(lines: list[str]) -> str:
    """A block of equations: those of a line stand beside each other where the page is wide enough."""
    out = ""
    for line in lines:
        number = re.search(r"\s{2,}\((\d+)\)\s*$", line)
        body = (line[:number.start()] if number else line).strip()
        remark = re.search(r"\s{2,}\(([A-Za-z].*)\)\s*$", body)
        body = body[:remark.start()] if remark else body
        terms = [mathml(term) for term in re.split(r",\s{2,}", body.rstrip(","))]
        cells = "".join(f"<span>{term}</span>" for term in terms)
        cells += f"<span class='remark'>{html.escape(remark.group(1))}</span>" if remark else ""
        label = f"<a class='number' id='eq-{number.group(1)}'>({number.group(1)})</a>" if number else ""
        out += f"<div class='equation'><div class='terms'>{cells}</div>{label}</div>\n"
    return out


def with_equations(page: str) -> str:
    """A Markdown page whose numbered equations are set; other indented lines stay as they are."""

    def one(match: re.Match[str]) -> str:
        lines = match.group().splitlines()
        if not any(re.search(r"\s{2,}\(\d+\)\s*$", line) for line in lines):
            return match.group()
        return _html(lines)

    return re.sub(r"(?:^ {4}\S.*\n)+", one, page, flags=re.MULTILINE)
