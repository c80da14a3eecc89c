"""No class has a friend in another file: what reaches into private members lies beside them."""

import re
import unittest
from pathlib import Path

from check_includes import ROOTS

ROOT = Path(__file__).resolve().parents[2]


def friends_elsewhere(text):
    """Names of the friends in a source text that the text itself does not define."""
    code = re.sub(r"//.*", "", text)
    friends = re.findall(r"\bfriend\s+(?:class\s+|struct\s+)?([\w:]+)\s*;", code)
    functions = re.findall(r"\bfriend\s+[^;{]*?([\w:]+)\s*\([^;{]*\)[^;{]*;", code)
    missing = [name for name in friends if not re.search(rf"\b(class|struct)\s+{name}\b[^;{{]*{{", code)]
    return missing + [name for name in functions if not re.search(rf"\b{name}\s*\([^;{{]*\)[^;{{]*{{", code)]


class Friends(unittest.TestCase):
    def test_no_class_has_a_friend_in_another_file(self):
        files = [path for top in ROOTS for path in (ROOT / top).rglob("*.[hc]pp")]
        self.assertGreater(len(files), 300)
        for path in files:
            with self.subTest(file=path.relative_to(ROOT).as_posix()):
                self.assertEqual([], friends_elsewhere(path.read_text(encoding="utf-8")))

    def test_finds_each_kind_of_friend(self):
        for declaration in ("friend class Other;", "friend struct Other;", "friend Other;", "friend prowl::Other;"):
            with self.subTest(declaration=declaration):
                self.assertEqual(1, len(friends_elsewhere(f"class Own {{\n  {declaration}\n  int x_;\n}};\n")))
        self.assertEqual(["reach"], friends_elsewhere("class Own { friend int reach(const Own& own); int x_; };"))

    def test_accepts_friends_beside_their_class(self):
        inside = "class Own { class Other { int get() const; }; friend class Other; int x_; };"
        self.assertEqual([], friends_elsewhere(inside))
        self.assertEqual(
            [], friends_elsewhere("class Own { friend bool operator==(const Own&, const Own&) = default; };")
        )
        self.assertEqual([], friends_elsewhere("class Own { friend int reach(const Own& own) { return own.x_; } };"))
        self.assertEqual([], friends_elsewhere("// friend class Other;"))


if __name__ == "__main__":
    unittest.main()
