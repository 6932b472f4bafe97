"""Small changes of the library's code: which there are, and code that holds many of them at once behind a switch."""
import bisect
import dataclasses
import hashlib
import re

# Formatted code has blanks around binary operators, and none in template brackets.
SWAPS = {
    "arithmetic": {" + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ", " *= ": " /= ",
                   " /= ": " *= "},
    "comparison": {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ", " && ": " || ",
                   " || ": " && "},
    "sign": {"(-": "(", " = -": " = ", "return -": "return ", ", -": ", ", " * -": " * "},
}
NUMBER = re.compile(r"(?<![\w.'\"])(\d+\.\d+(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+|\d+)(?![\w.'\"])")
INDEX = re.compile(r"(?<=[\w)\]])\[([^\[\]]+)\]")
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|(?<!\w)\'(?:[^\'\\\n]|\\.)*\'', re.DOTALL)
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|("(?:[^"\\\n]|\\.)*")', re.DOTALL)
CONTAINER = re.compile(r"\s*(template\b.*)?(inline |export )*(namespace|class|struct|union|enum|extern)\b[^()=]*$", re.DOTALL)
SKIPPED_LINE = re.compile(r"\s*(#|using |namespace |template|static_assert|static constexpr bool|throw |\[\[)")


@dataclasses.dataclass(frozen=True)
class Mutant:
    path: str  # below the root
    line: int  # from 1
    start: int  # in the line
    end: int
    kind: str
    text: str  # what stands there instead
    before: str  # the whole line
    function: str = ""  # a digest of the code of the function, or other declaration, around it

    @property
    def after(self):
        return self.before[:self.start] + self.text + self.before[self.end:]

    @property
    def identity(self):
        """Of the change and the file's name: neither other lines nor a move to another folder give another one."""
        return digest(self.path.split("/")[-1] + self.before.strip() + "\n" + self.after.strip())[:8]

    @property
    def room(self):
        folder = self.path.split("/")[-2]
        return "hompm" if folder == "kit" else folder


def digest(text):
    return hashlib.sha256(text.encode()).hexdigest()


def without_strings_and_comments(text):
    """The text with the same places, and \\0 for what is not code."""
    return NOT_CODE.sub(lambda match: re.sub(r"[^\n]", "\0", match[0]), text)


def declarations(text):
    """Where each function or other declaration outside functions begins, and a digest of its code, without comments and blanks.

    Those of a class or namespace stand for themselves; what is between them belongs to the next.
    """
    code = without_strings_and_comments(text)
    starts, digests, begin, depth, containers = [], [], 0, 0, 0
    for place, c in enumerate(code):
        if c == "{" and depth == 0 and CONTAINER.match(re.sub(r"#[^\n]*|\0", " ", code[begin:place])):
            containers += 1
        elif c in "{([":
            depth += 1
            continue
        elif c in "})]" and depth > 0:
            depth -= 1
            if c != "}" or depth > 0:
                continue
        elif c == "}" and containers > 0:
            containers -= 1
        elif c != ";" or depth > 0:
            continue
        starts.append(begin)
        digests.append(digest("".join(COMMENT.sub(lambda match: match[1] or "", text[begin:place + 1]).split()))[:12])
        begin = place + 1
    return starts, digests


def changed_number(text):
    if text.isdigit():
        return str(int(text) + 1)
    return "1.0" if float(text) == 0.0 else repr(2.0 * float(text))


def mutants_of_line(path, number, line, code, function):
    if SKIPPED_LINE.match(code):
        return
    for kind, swaps in SWAPS.items():
        for old, new in swaps.items():
            for match in re.finditer(re.escape(old), code):
                if kind == "arithmetic" and "\0" in code:
                    continue  # strings are joined, too
                if old in (" * ", " - ") and re.match(r"\s*(const )?\w+ \* \w+( =|;|,|\))", code):
                    continue  # a pointer
                if kind == "sign" and code[match.end():match.end() + 1] in ("-", ">", "="):
                    continue
                yield Mutant(path, number, match.start(), match.end(), kind, new, line, function)
    for match in NUMBER.finditer(code):
        yield Mutant(path, number, match.start(), match.end(), "constant", changed_number(match[0]), line, function)
    for match in INDEX.finditer(code):
        for step in (" + 1", " - 1"):
            yield Mutant(path, number, match.end() - 1, match.end() - 1, "index", step, line, function)


def mutants_of_file(path, text):
    code = without_strings_and_comments(text).split("\n")
    starts, digests = declarations(text)
    place = 0
    for number, line in enumerate(text.split("\n"), start=1):
        first = place + len(line) - len(line.lstrip())
        index = bisect.bisect_right(starts, first) - 1
        yield from mutants_of_line(path, number, line, code[number - 1], digests[index] if index >= 0 else "")
        place += len(line) + 1


# One program for many mutants. The expression around a change, `a + b`, becomes `(hompm_mutant(7) ? (a - b) : (a + b))`: the
# expression between the brackets, commas, semicolons, assignments and question marks next to it.

def expression_around(code, start, end):
    """Where the expression begins and ends; None when it is not all of one."""
    depth, left = 0, start
    while left > 0:
        c, before, behind = code[left - 1], code[left - 2:left - 1], code[left:left + 1]
        if c in ")]" or (c == "}" and re.match(r"\s*[-+*/<>=.?|&]", code[left:left + 80])):
            depth += 1
        elif c in "([{":
            if depth == 0:
                break
            depth -= 1
        elif depth == 0 and (c in ",;?}" or (c == ":" and before != ":" and behind != ":")
                             or (c == "=" and before not in "=<>!" and behind != "=")):
            break
        left -= 1
    depth, right = 0, end
    while right < len(code):
        c, before, behind = code[right], code[right - 1:right], code[right + 1:right + 2]
        if c in "([{":
            depth += 1
        elif c in ")]}":
            if depth == 0:
                break
            depth -= 1
        elif depth == 0 and (c in ",;?" or (c == ":" and before != ":" and behind != ":")
                             or (c == "=" and before not in "=<>!" and behind != "=")
                             or (c in "+-*/%" and behind == "=")):
            break
        right += 1
    left += len(code[left:start]) - len(code[left:start].lstrip(" \n\0"))
    while match := re.match(r"(return|else|do)\b\s*|(if|for|while)( constexpr)? (?=\()", code[left:start]):
        left += match.end()
        if match[2]:
            left = after_bracket(code, left)
        left += len(code[left:start]) - len(code[left:start].lstrip(" \n\0"))
    while right > end and code[right - 1] in " \n\0":
        right -= 1
    return (left, right) if left <= start and end <= right and left < right else None


def after_bracket(code, place):
    """Behind the bracket that opens at `place`."""
    depth = 0
    while place < len(code):
        depth += (code[place] in "([{") - (code[place] in ")]}")
        place += 1
        if depth == 0:
            break
    return place


def with_switches(text, numbers, hard=None):
    """The text with the mutants in it, each behind its number; `hard` is in it in any case.

    numbers: mutant to number. Returns the text and for each mutant the lines of its expression; those without are not in it.
    """
    code = without_strings_and_comments(text)
    lines = [0]
    for line in text.split("\n"):
        lines.append(lines[-1] + len(line) + 1)
    alternatives, places = {}, {}
    for mutant, number in numbers.items():
        start, end = lines[mutant.line - 1] + mutant.start, lines[mutant.line - 1] + mutant.end
        old, new = text[start:end], mutant.text
        while old and new and old[0] == new[0]:
            old, new, start = old[1:], new[1:], start + 1
        found = expression_around(code, start, end)
        if found is None:
            continue
        left, right = found
        changed = text[left:start] + new + text[end:right]
        alternatives.setdefault(found, []).append((number, re.sub(r"//[^\n]*", "", changed).replace("\n", " ")))
        places[mutant] = range(text.count("\n", 0, left) + 1, text.count("\n", 0, right) + 2)
    pieces = []

    def render(left, right, own):
        """The text between two places with all expressions that begin there, but `own` itself."""
        place = left
        inner = sorted((found for found in alternatives if left <= found[0] and found[1] <= right and found != own),
                       key=lambda found: (found[0], -found[1]))
        for found in inner:
            if found[0] < place:
                continue  # inside the one before
            pieces.append(text[place:found[0]] + "(")
            for number, changed in alternatives[found]:
                pieces.append(f"hompm_mutant({number}) ? ({changed}) : ")
            pieces.append("(")
            render(*found, found)
            pieces.append("))")
            place = found[1]
        pieces.append(text[place:right])

    if hard is not None:
        rows = text.split("\n")
        rows[hard.line - 1] = hard.after
        return "\n".join(rows), {}
    render(0, len(text), None)
    return "".join(pieces), places
