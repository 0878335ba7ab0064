//! Lettering for pictures: the public-domain 8x8 bitmap font, set proportionally.

use ::image::{Rgb, RgbImage};
use font8x8::legacy::BASIC_LEGACY;

/// Height of a line of letters [pixels at scale 1].
pub const HEIGHT: u32 = 8;

/// Width of a space [pixels at scale 1].
const SPACE: u32 = 4;

/// Rows of a letter, the lowest bit leftmost; a question mark for what the font lacks.
fn glyph(letter: char) -> [u8; 8] {
    BASIC_LEGACY[usize::try_from(u32::from(letter))
        .ok()
        .filter(|&i| (32..127).contains(&i))
        .unwrap_or('?' as usize)]
}

/// First inked column of a letter and the number of columns up to the last.
fn extent(rows: &[u8; 8]) -> (u32, u32) {
    let ink = rows.iter().fold(0u8, |all, row| all | row);
    if ink == 0 {
        return (0, SPACE - 1);
    }
    (ink.trailing_zeros(), 8 - ink.leading_zeros() - ink.trailing_zeros())
}

/// Width of a line of text \[pixels\].
pub fn width(text: &str, scale: u32) -> u32 {
    let columns: u32 = text.chars().map(|c| extent(&glyph(c)).1 + 1).sum();
    columns.saturating_sub(1) * scale
}

/// Draws a line of text with its top left corner at (x, y); what lies outside the picture is left out.
pub fn draw(picture: &mut RgbImage, x: u32, y: u32, scale: u32, color: Rgb<u8>, text: &str) {
    let mut left = x;
    for letter in text.chars() {
        let rows = glyph(letter);
        let (first, columns) = extent(&rows);
        for (row, bits) in rows.iter().enumerate() {
            for column in 0..columns {
                if bits >> (first + column) & 1 == 1 {
                    fill(
                        picture,
                        left + column * scale,
                        y + row as u32 * scale,
                        scale,
                        scale,
                        color,
                    );
                }
            }
        }
        left += (columns + 1) * scale;
    }
}

/// Fills a rectangle, as much of it as lies inside the picture.
pub fn fill(picture: &mut RgbImage, x: u32, y: u32, width: u32, height: u32, color: Rgb<u8>) {
    for y in y..y.saturating_add(height).min(picture.height()) {
        for x in x..x.saturating_add(width).min(picture.width()) {
            picture.put_pixel(x, y, color);
        }
    }
}

/// Breaks a name into lines no wider than `widest`, after a hyphen, colon, plus, slash or space where there is one in reach.
pub fn wrap(name: &str, scale: u32, widest: u32) -> Vec<String> {
    let mut lines = vec![];
    let mut line = String::new();
    for letter in name.chars() {
        line.push(letter);
        while width(&line, scale) > widest && line.chars().count() > 1 {
            let last = line.len() - letter.len_utf8();
            let at = line[..last]
                .rfind(['-', ':', '+', '/', ' ', '_'])
                .map_or(last, |i| i + 1);
            let rest = line.split_off(at);
            lines.push(std::mem::replace(&mut line, rest));
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn letters_leave_ink_within_their_width() {
        let (white, black) = (Rgb([255; 3]), Rgb([0; 3]));
        let text = "Ag-7:+";
        let mut picture = RgbImage::from_pixel(200, 20, white);
        draw(&mut picture, 3, 2, 2, black, text);
        let inked: Vec<u32> = picture
            .enumerate_pixels()
            .filter(|&(.., &p)| p == black)
            .map(|(x, ..)| x)
            .collect();
        assert_eq!(
            (inked.iter().min(), inked.iter().max()),
            (Some(&3), Some(&(3 + width(text, 2) - 1)))
        );
        assert_eq!(glyph('é'), glyph('?'));
        // Far outside: nothing, and no panic.
        draw(&mut picture, 1000, 1000, 3, black, text);
    }

    proptest! {
        #[test]
        fn wrapping_loses_nothing_and_fits(name in "[a-z:+é -]{0,60}", widest in 20u32..300) {
            let lines = wrap(&name, 2, widest);
            prop_assert_eq!(lines.concat(), name);
            prop_assert!(lines.iter().all(|l| width(l, 2) <= widest), "{:?}", lines);
        }
    }
}
