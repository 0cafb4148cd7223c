# SPDX-License-Identifier: MIT
"""What the program tells of itself: pages of the manual, and completions as the shells understand them (a shell
that is not installed is left out).
"""
import os
import pty
import re
import select
import shutil
import subprocess
import time
import unittest

import cli

TOOLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "csgmesh")


def text_of(*arguments):
    return cli.run(*arguments).stdout.decode()


def commands():
    with open(os.path.join(TOOLS, "core", "commands.def"), encoding="utf-8") as file:
        return re.findall(r"^COMMAND\(\w+, (\w+),", file.read(), re.M)


def options_of(command):
    """The long options that the help of a command lists."""
    return set(re.findall(r"^  (?:-\w, |    )(--[\w-]+)", text_of("help", command), re.M))


class Help(cli.CliTest):
    def test_every_command_has_its_page_and_help(self):
        self.assertGreater(len(commands()), 14)
        whole = text_of("man")
        for command in commands():
            self.assertIn(f"csgmesh\\-{command} (1)", whole)
            page = text_of("man", command)
            self.assertTrue(page.startswith('.\\" SPDX'), page[:40])
            self.assertIn(f".TH CSGMESH-{command.upper()} 1 ", page)
            written = {word.replace("\\-", "-") for word in re.findall(r"\\fB(\\-\\-[\w\\-]+?)\\fR", page)}
            self.assertEqual(written, options_of(command))

    def test_render_speaks_of_pictures_only(self):
        text = text_of("help", "render")
        for word in ("triangles", "svg", "stl", "meshed", "diff:", "comparing"):
            self.assertNotIn(word, text)
        self.assertIn("write the picture to FILE, .png or .ppm", text)
        self.assertIn("a flat scene is drawn as .svg", " ".join(text_of("help", "mesh").split()))
        self.assertNotIn("seen best", text)
        self.assertIn("seen best", " ".join(text_of("help", "diff").split()))

    def test_commands_that_only_talk_take_no_limits(self):
        for command in ("help", "man", "version", "completion"):
            self.assertNotIn("--max-memory", text_of("help", command))
            self.assert_refused(cli.run(command, "--max-memory", "1G"), 2, "does not apply")

    def test_topics(self):
        for command in ("help", "man"):
            self.assert_refused(cli.run(command, "rendr"), 2, "no command 'rendr'", "did you mean 'render'?")
            self.assert_refused(cli.run(command, "mesh", "diff"), 2, "'diff' is one too many")

    def test_version(self):
        self.assertEqual(text_of("version"), text_of("--version"))
        self.assertEqual(text_of("-V"), text_of("--version"))
        self.assert_refused(cli.run("version", "9"), 2, "takes no '9'")

    def test_unknown_commands(self):
        self.write("mug.txt", cli.BALL)
        for name, words in (("chek", ["did you mean 'check'?"]), ("xyzzy", ["csgmesh help lists the commands"]),
                            ("mug", ["did you mean 'mug.txt'?"])):
            self.assert_refused(self.run_in(name, "mug.txt", "--json"), 2,
                                f"there is no command and no file '{name}'", *words)
        self.write("rendre", cli.BALL) # a file is a scene, whatever it is called
        self.assert_status(self.run_in("rendre", "-r", "8", "-o", "a.ply"), 0)
        self.assert_refused(self.run_in("chek.txt", "-o", "a.ply"), 2, "chek.txt", "No such file")


@unittest.skipUnless(shutil.which("man"), "man is not installed")
class Pages(cli.CliTest):
    def test_man_reads_them(self):
        for topic in ([], *([name] for name in commands())):
            self.write("page.1", text_of("man", *topic))
            result = subprocess.run(["man", "--warnings", "-l", "page.1"], cwd=self.folder, capture_output=True,
                                    text=True, check=False, env={**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "80"})
            self.assertEqual((result.returncode, result.stderr), (0, ""), topic)
            self.assertIn("SEE ALSO", result.stdout)
        self.assertIn(".obj .ply .stl", text_of("man"))


class Completion(cli.CliTest):
    """The same lines in each shell; what they must offer, and what not."""
    LINES = [("csgmesh rend", {"render"}, {"mesh"}),
             ("csgmesh --qui", {"--quiet"}, {"--quality"}),
             ("csgmesh mug.txt --qua", {"--quality"}, {"--quiet"}),
             ("csgmesh mesh --quality d", {"draft"}, {"fine"}),
             ("csgmesh --quality fine diff --ignore-t", {"--ignore-topology"}, set()),
             ("csgmesh completion z", {"zsh"}, {"bash"}),
             ("csgmesh help comp", {"completion"}, {"check"}),
             ("csgmesh render --tur", {"--turntable"}, {"--triangles"}),
             ("csgmesh openscad --autoc", {"--autocenter"}, set()),
             ("csgmesh batch -f gl", {"glb", "gltf"}, {"stl"})]

    def setUp(self):
        super().setUp()
        self.write("mug.txt", cli.BALL)
        self.write("mug.glb", "")
        os.mkdir(self.path("parts"))

    def script(self, shell):
        text = text_of("completion", shell)
        self.write(f"csgmesh.{shell}", text)
        return text

    def shell(self, *command):
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False, timeout=60,
                                env={**os.environ, "HOME": self.folder, "LC_ALL": "C.UTF-8"})
        self.assertEqual((result.returncode, result.stderr), (0, ""), command)
        return result.stdout

    def test_trouble(self):
        self.assert_refused(cli.run("completion"), 2, "no shell given", "bash, zsh or fish")
        self.assert_refused(cli.run("completion", "csh"), 2, "no completions for the shell 'csh'")
        self.assert_refused(cli.run("completion", "bash", "zsh"), 2, "one shell at a time")

    def test_every_option_is_there(self):
        for shell in ("bash", "zsh", "fish"):
            text = self.script(shell)
            for command in commands():
                for option in options_of(command):
                    self.assertIn(f"-l {option[2:]} " if shell == "fish" else option, text)

    @unittest.skipUnless(shutil.which("bash"), "bash is not installed")
    def test_bash(self):
        self.script("bash")

        def ask(line, words=None):
            words = words or line.split(" ")
            quoted = " ".join(f"'{word}'" for word in words)
            text = self.shell("bash", "--norc", "-uc", "source csgmesh.bash; complete -p csgmesh >/dev/null || exit 9; "
                              f"COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; "
                              "_csgmesh 2>&1; printf '%s\\n' \"${COMPREPLY[@]}\"")
            return set(text.split("\n")) - {""}

        for line, wanted, unwanted in self.LINES:
            found = ask(line)
            self.assertEqual(found & (wanted | unwanted), wanted, line)
        self.assertEqual(ask("csgmesh check "), {"mug.txt", "parts"})
        self.assertEqual(ask("csgmesh mu"), {"mug.txt"})
        self.assertEqual(ask("csgmesh info mu"), {"mug.txt", "mug.glb"})
        self.assertEqual(ask("csgmesh check mug.g"), {"mug.glb"}, "no scene begins so: any file")
        self.assertEqual(ask("csgmesh mug.txt -I "), {"parts"})
        self.assertEqual(ask("", ["csgmesh", "mug.txt", "--color", "=", "al"]), {"always"})
        self.assertEqual(ask("", ["csgmesh", "mug.txt", "--stats", "=", "mug.g"]), {"mug.glb"})
        self.assertEqual(ask("csgmesh mug.txt -r "), set())
        self.assertEqual(ask("csgmesh version "), set())

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish(self):
        self.script("fish")
        lines = [line for line, _, _ in self.LINES]
        asked = "; ".join(f"complete -C'{line}'; echo ===" for line in lines)
        answers = self.shell("fish", "--no-config", "-c", f"source csgmesh.fish; {asked}").split("===\n")
        for (line, wanted, unwanted), answer in zip(self.LINES, answers):
            found = {row.split("\t")[0] for row in answer.splitlines()}
            self.assertEqual(found & (wanted | unwanted), wanted, line)

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh(self):
        """In a terminal, as zsh completes nowhere else; each line ends in what TAB made of it."""
        self.script("zsh")
        self.write(".zshrc", "PS1='> '; unsetopt beep; setopt no_list_ambiguous; LISTMAX=9999\n"
                   "autoload -Uz compinit; compinit -u -D; source ./csgmesh.zsh\n"
                   "show() { print -r -- \"<<$BUFFER>>\" > /dev/tty; BUFFER= }; zle -N show; bindkey '^O' show\n"
                   "bindkey '^I' expand-or-complete\nprint -r -- '<<ready>>'\n")
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.folder)
            os.execvpe("zsh", ["zsh", "-i"], {**os.environ, "HOME": self.folder, "ZDOTDIR": self.folder,
                                              "TERM": "dumb", "LC_ALL": "C.UTF-8", "COLUMNS": "200"})
        try:
            self.assertEqual(self.wait_for_mark(terminal), "ready")
            for line, whole in (("csgmesh rend", "csgmesh render "), ("csgmesh --qui", "csgmesh --quiet "),
                                ("csgmesh mug.txt --qua", "csgmesh mug.txt --quality="),
                                ("csgmesh mesh --quality d", "csgmesh mesh --quality draft "),
                                ("csgmesh --quality fine diff --ignore-t",
                                 "csgmesh --quality fine diff --ignore-topology "),
                                ("csgmesh completion z", "csgmesh completion zsh "),
                                ("csgmesh help comp", "csgmesh help completion "),
                                ("csgmesh check mu", "csgmesh check mug.txt "),
                                ("csgmesh mu", "csgmesh mug.txt "),
                                ("csgmesh openscad --autoc", "csgmesh openscad --autocenter "),
                                ("csgmesh batch -f gl", "csgmesh batch -f gl"),
                                ("csgmesh render --stats=mug.g", "csgmesh render --stats=mug.glb ")):
                os.write(terminal, line.encode() + b"\t\x0f")
                self.assertEqual(self.wait_for_mark(terminal), whole)
        finally:
            os.close(terminal)
            os.waitpid(child, 0)

    def wait_for_mark(self, terminal):
        """What zsh shows between << and >>; no time is right but that after which it hangs."""
        text, end = "", time.monotonic() + 60
        while time.monotonic() < end:
            ready, _, _ = select.select([terminal], [], [], 1)
            if ready:
                text += os.read(terminal, 4096).decode(errors="replace")
            marks = re.findall(r"<<([^<>\r\n]*)>>", text)
            if marks:
                return marks[-1]
        self.fail(f"zsh says nothing: {text[-300:]!r}")


if __name__ == "__main__":
    cli.main()
