#!/usr/bin/env python3
"""What the samples change is put away: whoever adds a member says whether it is.

Every class with a listing (`archive(Archive& a)`, in its body or in a source beside it) names each
of its data members there, or says why not in a comment of the listing:

    // not archived: settings_, limits_ (construction)

check_archive.py           looks at core and daemon
check_archive.py --test    looks at samples, and tells whether it finds what is wrong with them
"""
import pathlib
import re
import sys

LISTING = re.compile(r"\bvoid\s+((?:\w+::)*)archive\(Archive&")
NO_MEMBERS = ("using ", "static ", "friend ", "enum ", "typedef ", "template ", "class ", "struct ", "virtual ")
LEFT_OUT = re.compile(r"not archived:\s*([\w,\s]+?)\s*\(([^)]+)\)")


def blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def without_comments(text):
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', lambda m: '"' + " " * (len(m[0]) - 2) + '"', text)
    return re.sub(r"//[^\n]*|/\*.*?\*/|^[ \t]*#[^\n]*", blank, text, flags=re.S | re.M)


def end_of_block(text, opening):
    depth = 0
    for at in range(opening, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return at
    return len(text) - 1


def statements(body):
    """Of a class, without the blocks in them; what ends in one that is no initialiser ends there."""
    out, now, at = [], "", 0
    while at < len(body):
        if body[at] == "{":
            close = end_of_block(body, at)
            after = body[close + 1:].lstrip()[:1]
            now += "{}"
            at = close + 1
            if after not in (";", ","):
                out.append(now)
                now = ""
        elif body[at] == ";":
            out.append(now)
            now = ""
            at += 1
        else:
            now += body[at]
            at += 1
    return [re.sub(r"\b(public|private|protected)\s*:(?!:)", " ", one).strip() for one in out]


def names_in(statement):
    """The data members that it declares."""
    statement = re.sub(r"\[\[.*?\]\]|\bmutable\b", " ", statement).strip()
    if not statement or statement.startswith(NO_MEMBERS) or re.match(r"(class|struct|enum)\b", statement):
        return []
    while re.search(r"<[^<>]*>", statement):
        statement = re.sub(r"<[^<>]*>", " ", statement)
    first = re.search(r"[(={,\[]", statement)
    if "operator" in statement or (first and first[0] == "("):
        return []
    while re.search(r"\([^()]*\)", statement):  # of initialisers
        statement = re.sub(r"\([^()]*\)", " ", statement)
    parts = [re.split(r"[={\[]", part)[0] for part in statement.split(",")]
    words = [re.findall(r"\w+", part) for part in parts]
    return [each[-1] for each in words if each and (len(words[0]) > 1)]


def classes_of(text, outer=""):
    """name, bases, body with its comments, of all classes in it, nested ones too."""
    code = without_comments(text)
    for head in re.finditer(r"\b(class|struct)\s+((?:\w+::)*\w+)\s*(?:final\s*)?(:[^;{()]*)?\{", code):
        close = end_of_block(code, head.end() - 1)
        yield head[2], head[3] or "", head.start(), head.end(), close


def full_names(text):
    spans = list(classes_of(text))
    for name, bases, start, begin, end in spans:
        around = [other for other, _, s, _, e in spans if s < start and end < e]
        yield "::".join(around + [name]), bases, begin, end, [
            (s, e) for _, _, s, _, e in spans if begin <= s and e < end]


def check(files):
    """files: {name: text}. What is wrong, a line each."""
    bodies, wrong, listed = {}, [], {}
    for name, text in files.items():
        code = without_comments(text)
        for found in LISTING.finditer(code):
            if not found[1]:
                continue
            opening = re.compile(r"[{;]").search(code, found.end())
            if opening and opening[0] == "{":
                bodies[found[1][:-2]] = text[opening.start():end_of_block(code, opening.start()) + 1]
    for name, text in files.items():
        code = without_comments(text)
        for full, bases, begin, end, nested in full_names(text):
            own = list(range(begin, end))
            body, raw = code[begin:end], text[begin:end]
            for s, e in nested:  # a nested class speaks for itself
                body = body[:s - begin] + re.sub(r"[^\n{};]", " ", body[s - begin:e - begin + 1]).replace("{", " ").replace("}", " ").replace(";", " ") + body[e - begin + 1:]
            found = LISTING.search(body)
            if not found or found[1]:
                continue
            opening = re.compile(r"[{;]|=\s*0").search(body, found.end())
            if opening[0] == "{":
                listing = raw[opening.start():end_of_block(body, opening.start()) + 1]
            elif opening[0] == ";":
                listing = bodies.get(full)
                if listing is None:
                    wrong.append(f"{name}: {full} has a listing that is nowhere")
                    continue
            else:
                continue
            members = [m for one in statements(body) for m in names_in(one)]
            listed[full] = (name, bases, listing)
            comments = " ".join(re.findall(r"//([^\n]*)", listing))
            left_out = {one.strip() for m in LEFT_OUT.finditer(comments) for one in m[1].split(",")}
            said = without_comments(listing)
            for member in members:
                if not re.search(rf"\b{member}\b", said) and member not in left_out:
                    wrong.append(f"{name}: {full}::{member} is not put away: name it in the listing, "
                                 "or say there why not (// not archived: member (reason))")
            for member in sorted(left_out - set(members)):
                wrong.append(f"{name}: {full} has no {member} to leave out")
    for full, (name, bases, listing) in listed.items():
        for base in re.findall(r"\w+", bases):
            if base in listed and f"{base}::archive(" not in listing:
                wrong.append(f"{name}: {full} does not put away what it has of {base}")
    return wrong, len(listed)


HEADER = """
class Inner { public: template <class Archive> void archive(Archive& a) { a(x_, y_); }
 private: double x_ = 0.0, y_{1.0}; %s };
class Outer : Inner {
 public:
  explicit Outer(int size) : size_(size), inner_(size) {}
  [[nodiscard]] int size() const { return size_; }
  void archive(Archive& a);
 private:
  struct Part { std::vector<int> list; bool flag = false; %s void archive(Archive& a); };
  static constexpr int kMost = 3;
  std::function<void(int, double)> sink_;
  int size_;                                       // fixed
  std::array<std::vector<Part>, 2> parts_; Inner inner_; %s
};
"""
SOURCE = """
void Outer::Part::archive(Archive& a) { a(list, flag); }
void Outer::archive(Archive& a) {
  // not archived: size_, sink_ (construction)%s
  %s a(parts_, inner_);
}
"""


def test():
    """Each: members added, what stands in the source, and what is to be found."""
    base = "Inner::archive(a);"
    cases = [
        (("", "", ""), ("", base), []),
        (("int more_ = 0;", "", ""), ("", base), ["Inner::more_"]),
        (("", "Eigen::Matrix<double, 2, 3> m;", ""), ("", base), ["Outer::Part::m"]),
        (("", "", "std::map<int, double> a_, b_;"), ("", base), ["Outer::a_", "Outer::b_"]),
        (("", "", "std::optional<int> late_ = std::max(1, 2);"), ("", base), ["Outer::late_"]),
        (("", "", "std::map<int, double> a_;"), ("\n// not archived: a_ (empty between calls)", base), []),
        (("", "", "int a_;"), ("\n// not archived: a_", base), ["Outer::a_"]),
        (("", "", ""), ("\n// not archived: gone_ (construction)", base), ["no gone_"]),
        (("", "", ""), ("", ""), ["what it has of Inner"]),
    ]
    failed = 0
    for added, source, expected in cases:
        wrong, _ = check({"a.hpp": HEADER % added, "a.cpp": SOURCE % source})
        if len(wrong) != len(expected) or not all(e in w for e, w in zip(expected, wrong)):
            failed += 1
            print(f"expected {expected}, found {wrong}")
    return failed


def main():
    if sys.argv[1:] == ["--test"]:
        return 1 if test() else 0
    root = pathlib.Path(__file__).resolve().parents[2]
    files = {str(path.relative_to(root)): path.read_text()
             for room in ("core", "daemon") for path in sorted((root / room).rglob("*.[ch]pp"))
             if path.parent.name != "archive"}
    wrong, count = check(files)
    print("\n".join(wrong))
    print(f"{count} classes are put away")
    return 1 if wrong or count < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
