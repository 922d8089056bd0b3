//! What a text takes in memory to be read, told from its tokens before it is parsed: a parser that runs out of memory ends the
//! program without a word.

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

use super::read::Syntax;
use crate::InputError;

/// Memory that a file may take to be read, about [bytes].
const MOST: usize = 1 << 30;
/// Of a token with all that the parsers and the tree make of it, and of a table besides [bytes]: as measured, rounded up.
const TOKEN: usize = 100;
const TABLE: usize = 2000;

/// Refuses a text that takes too much; `kind` is what the message calls it.
pub(super) fn check(text: &str, syntax: Syntax) -> Result<(), InputError> {
    let [tokens, tables] = match syntax {
        Syntax::Toml => of_toml(text),
        Syntax::Json => of_json(text),
    };
    if tokens.saturating_mul(TOKEN).saturating_add(tables.saturating_mul(TABLE)) <= MOST {
        return Ok(());
    }
    let what = format!("the file says too much: {tables} tables, and {tokens} words, numbers and signs");
    let allowed = format!("{} of both, a table counting as {}", MOST / TOKEN, TABLE / TOKEN);
    Err(InputError::new(what).allowed(allowed).help("what repeats itself may be laid by a bond, or chosen by a region"))
}

/// Tokens and tables. A table is opened by a brace, a heading, or a point in a key.
fn of_toml(text: &str) -> [usize; 2] {
    let [mut tokens, mut tables] = [0; 2];
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
    [tokens, tables]
}

/// Signs within texts are counted too: there are few of them.
fn of_json(text: &str) -> [usize; 2] {
    let count = |sign: &[u8]| text.bytes().filter(|b| sign.contains(b)).count();
    // A value before each comma and at each end, a name before each colon.
    [2 * count(b",:[{"), count(b"{")]
}
