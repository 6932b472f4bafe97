#!/usr/bin/env python3
"""Writes manual pages and completion for bash, zsh and fish from what the tools say of themselves.

    cli/make_man.py BIN_DIR OUTPUT_DIR

BIN_DIR holds hompm-run, hompm-diff, hompm-study and hompm-exact; they are asked by `--help --json`, and hompm-run by `--list --json`.
OUTPUT_DIR gets man1/TOOL.1.gz, bash/TOOL, zsh/_TOOL and fish/TOOL.fish.
"""
import gzip
import json
import pathlib
import subprocess
import sys

TOOLS = ["hompm-run", "hompm-diff", "hompm-study", "hompm-exact"]
FILES = ("FILE", "DIR")  # values that are names of files or folders


def told(tool, *options):
    return json.loads(subprocess.run([tool, *options, "--json"], capture_output=True, text=True, check=True).stdout)


def options_of(help_text):
    """(long, letter or "", value, meaning) of each option."""
    for topic in help_text["topics"]:
        for option in topic["options"]:
            long, _, letter = option["name"].partition(",")
            yield long, letter, option["value"], option["meaning"]


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("…", "...")
    return "\\&" + text if text.startswith((".", "'")) else text


def manual(help_text, version):
    name = help_text["name"]
    lines = [f'.TH {name.upper()} 1 "" "hompm {version}" "User Commands"', ".SH NAME", f"{name} \\- {roff(help_text['about'].split(';')[0].rstrip('.'))}",
             ".SH SYNOPSIS", f".B {roff(name)}", roff(help_text["usage"]), ".SH DESCRIPTION", roff(help_text["about"]), ".SH OPTIONS"]
    for topic in help_text["topics"]:
        lines += [f".SS {topic['name'].capitalize()}", roff(topic["about"][0].upper() + topic["about"][1:] + ".")]
        for long, letter, value, meaning in options_of({"topics": [topic]}):
            words = (f"\\fB\\-{letter}\\fR, " if letter else "") + f"\\fB\\-\\-{roff(long)}\\fR" + (f" \\fI{roff(value)}\\fR" if value else "")
            lines += [".TP", words, roff(meaning)]
    lines.append(".SH EXAMPLES")
    examples = help_text["examples"] + [example for topic in help_text["topics"] for example in topic["examples"]]
    lines += [".nf", *map(roff, examples), ".fi", ".SH NOTES"]
    for paragraph in help_text["remarks"].strip().split("\n\n"):
        lines += [".PP", roff(" ".join(paragraph.split("\n")))]
    others = ", ".join(f".BR {tool} (1)" for tool in TOOLS if tool != name).split(", ")
    return "\n".join([*lines, ".SH SEE ALSO", *others]) + "\n"


def words_of(option, catalogue):
    """What may stand behind an option, where that is a word from a list."""
    return {"case": sorted({case["case"] for case in catalogue["cases"]}), "variant": sorted({case["variant"] for case in catalogue["cases"]}),
            "scheme": [scheme["name"] for scheme in catalogue["schemes"]], "field": ["displacement", "velocity", "stress"]}.get(option, [])


def bash(help_text, catalogue):
    name = help_text["name"]
    function = "_" + name.replace("-", "_")
    longs = " ".join(f"--{long}" for long, *_ in options_of(help_text))
    cases = [f"    --{long}) COMPREPLY=($(compgen -W '{' '.join(words)}' -- \"$cur\")); return ;;" for long, *_ in options_of(help_text)
             if (words := words_of(long, catalogue))]
    topics = " ".join(topic["name"] for topic in help_text["topics"])
    return "\n".join([f"{function}() {{", '  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}', "  case $prev in", *cases,
                      f"    --help) COMPREPLY=($(compgen -W '{topics}' -- \"$cur\")); return ;;", "  esac",
                      f"  if [[ $cur == -* ]]; then COMPREPLY=($(compgen -W '{longs}' -- \"$cur\")); else COMPREPLY=($(compgen -f -- \"$cur\")); fi", "}",
                      f"complete -o filenames -F {function} {name}"]) + "\n"


def zsh(help_text, catalogue):
    lines = [f"#compdef {help_text['name']}", "_arguments \\"]
    for long, _, value, meaning in options_of(help_text):
        said = meaning.translate(str.maketrans({"[": "(", "]": ")", "'": "", ":": ","}))
        words = words_of(long, catalogue)
        action = f":{value.rstrip('.')}:({' '.join(words)})" if words else f":{value}:_files" if value in FILES else f":{value.rstrip('.')}: " if value else ""
        lines.append(f"  '{'*' if value.endswith('...') else ''}--{long}[{said}]{action.replace('KEY=VALUE', 'KEY VALUE')}' \\")
    return "\n".join([*lines, "  '*:file:_files'"]) + "\n"


def fish(help_text, catalogue):
    lines = []
    for long, letter, value, meaning in options_of(help_text):
        words = words_of(long, catalogue)
        quoted = meaning.replace("\\", "\\\\").replace("'", "\\'")
        lines.append(f"complete -c {help_text['name']} -l {long}" + (f" -s {letter}" if letter else "") +
                     (f" -x -a '{' '.join(words)}'" if words else " -r" if value in FILES else " -x" if value else "") + f" -d '{quoted}'")
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    bin_dir, output = map(pathlib.Path, sys.argv[1:])
    catalogue = told(bin_dir / "hompm-run", "--list")
    for tool in TOOLS:
        help_text = told(bin_dir / tool, "--help")
        version = told(bin_dir / tool, "--version")["version"]
        texts = {f"bash/{tool}": bash(help_text, catalogue), f"zsh/_{tool}": zsh(help_text, catalogue), f"fish/{tool}.fish": fish(help_text, catalogue)}
        for name, text in texts.items():
            (output / name).parent.mkdir(parents=True, exist_ok=True)
            (output / name).write_text(text, encoding="utf-8")
        (output / "man1").mkdir(exist_ok=True)
        (output / f"man1/{tool}.1.gz").write_bytes(gzip.compress(manual(help_text, version).encode(), 9, mtime=0))


if __name__ == "__main__":
    main()
