//! What a text takes in memory to be read, told from its tokens before it is parsed: a parser that runs out of memory ends the
//! program without a word.

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

use super::node::Syntax;
use crate::InputError;

/// Memory that a file may take to be read, about [bytes].
const MOST: usize = 1 << 30;
/// Of a token with all that the parsers and the tree make of it; of a table and of a list besides [bytes]: as measured.
const TOKEN: usize = 80;
const TABLE: usize = 1000;
const LIST: usize = 200;

/// What is counted of a text.
#[derive(Default)]
struct Counts {
    tokens: usize,
    tables: usize,
    lists: usize,
}

/// Refuses a text that takes too much.
pub(super) fn check(text: &str, syntax: Syntax) -> Result<(), InputError> {
    let Counts { tokens, tables, lists } = match syntax {
        Syntax::Toml => of_toml(text),
        Syntax::Json => of_json(text),
    };
    // No count exceeds the length of the text.
    let takes = TOKEN * tokens + TABLE * tables + LIST * lists;
    if takes <= MOST {
        return Ok(());
    }
    let gibibytes = takes as f64 / (1u64 << 30) as f64;
    let what = format!("takes about {gibibytes:.1} GiB of memory to be read: it has {tables} tables");
    let error = InputError::new(what).allowed("up to 1 GiB, as some 200,000 blocks take that are given one by one");
    Err(error.help("blocks may be laid by a bond, and joints be changed by kind, course, panel and region"))
}

/// A table is opened by a brace, a heading, or a point in a key.
fn of_toml(text: &str) -> Counts {
    let Counts { mut tokens, mut tables, mut lists } = Counts::default();
    // Points since the last sign that a key can follow on; brackets that are open; whether a line is a heading.
    let (mut points, mut open, mut heading, mut begins) = (0, 0usize, false, true);
    for token in Source::new(text).lex() {
        tokens += 1;
        match token.kind() {
            TokenKind::Dot => points += 1,
            TokenKind::Equals => {
                tables += points;
                points = 0;
            }
            TokenKind::LeftCurlyBracket => {
                tables += 1;
                (points, open) = (0, open + 1);
            }
            TokenKind::LeftSquareBracket => {
                heading |= begins && open == 0;
                lists += 1;
                (points, open) = (0, open + 1);
            }
            TokenKind::RightCurlyBracket | TokenKind::RightSquareBracket => open = open.saturating_sub(1),
            TokenKind::Comma => points = 0,
            TokenKind::Newline => {
                tables += if heading { 1 + points } else { 0 };
                (points, heading) = (0, false);
            }
            _ => {}
        }
        begins = match token.kind() {
            TokenKind::Newline => true,
            TokenKind::Whitespace => begins,
            _ => false,
        };
    }
    Counts { tokens, tables, lists }
}

/// Signs within texts are counted too: there are few of them.
fn of_json(text: &str) -> Counts {
    let count = |sign: &[u8]| text.bytes().filter(|b| sign.contains(b)).count();
    // A value before each comma and at each end, a name before each colon.
    Counts { tokens: 2 * count(b",:[{"), tables: count(b"{"), lists: count(b"[") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_counted_however_they_are_opened() {
        for (text, tables) in [
            ("a = 1.5\nb = \"{.[\"  # {.[\nc = [0.1, 0.2]\n", 0),
            ("[a]\nx = 1\n[b.c]\n[[d]]\n", 4),
            ("a = { b = 1, c.d = 2, e = [{}, {}] }\na.b.c = 0.5\n", 6),
            ("a = [\n[0.1, 0.2],\n[0.3]\n]\n", 0),
        ] {
            assert_eq!(of_toml(text).tables, tables, "{text}");
        }
        assert_eq!(of_json(r#"{"a": [{}, {"b": 1}]}"#).tables, 3);
    }
}
