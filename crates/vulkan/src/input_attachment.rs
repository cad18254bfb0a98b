//! Fragment shaders that read input attachments.
//!
//! WGSL has no input attachments: the suite's shaders fetch the texel of a texture under the fragment. This
//! module turns the textures of naga's SPIR-V into subpass data, and their fetches into reads at the fragment's
//! own place.

use crate::spirv::{
    BINDING, CAPABILITY, CONSTANT_NULL, DECORATE, FUNCTION, IMAGE_FETCH, IMAGE_READ, TYPE_IMAGE,
    TYPE_INT, TYPE_VECTOR, instruction, instructions,
};

/// The input attachment that a texture becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Input {
    /// The attachment with this number.
    Numbered(u32),
    /// The attachment without a number.
    Unnumbered,
}

/// The input attachments that textures 0 and 1 become, if they are attachments of the pass.
pub(crate) type Inputs = [Option<Input>; 2];

/// The capability InputAttachment.
const INPUT_ATTACHMENT: u32 = 40;
/// The decoration InputAttachmentIndex.
const INPUT_ATTACHMENT_INDEX: u32 = 43;
/// The dimension SubpassData.
const SUBPASS_DATA: u32 = 6;
/// The image operand Sample.
const SAMPLE: u32 = 0x40;

/// Returns the module with textures 0 and 1 turned into input attachments, if they are given.
pub(crate) fn as_inputs(words: &[u32], inputs: Inputs) -> Vec<u32> {
    let (header, instructions) = instructions(words);
    let is = |line: &[u32], code: u32| line[0] & 0xffff == code;
    let find = |code: u32, tail: &[u32]| {
        let mut found = instructions.iter().filter(|line| is(line, code));
        found.find(|line| line[2..] == *tail).map(|line| line[1])
    };
    let signed = find(TYPE_INT, &[32, 1]).unwrap_or_default();
    let pair = find(TYPE_VECTOR, &[signed, 2]).unwrap_or_default();
    let own_place = header[3];
    let mut out = header.to_vec();
    out[3] += 1;
    out.extend(instruction(CAPABILITY, &[INPUT_ATTACHMENT]));
    let mut declared = false;
    for line in instructions {
        if !declared && is(line, FUNCTION) {
            out.extend(instruction(CONSTANT_NULL, &[pair, own_place]));
            declared = true;
        }
        if is(line, TYPE_IMAGE) {
            // Result, sampled type, dimension, depth, arrayed, multisampled, sampled, format.
            let mut image = line[1..].to_vec();
            (image[2], image[6]) = (SUBPASS_DATA, 2);
            out.extend(instruction(TYPE_IMAGE, &image));
        } else if is(line, IMAGE_FETCH) {
            let mut read = vec![line[1], line[2], line[3], own_place];
            if line.get(5) == Some(&SAMPLE) {
                read.extend(&line[5..]);
            }
            out.extend(instruction(IMAGE_READ, &read));
        } else {
            out.extend(line);
        }
        // Texture 0 is at binding 1.
        if is(line, DECORATE)
            && line[2] == BINDING
            && let Some(Some(Input::Numbered(number))) =
                line[3].checked_sub(1).and_then(|t| inputs.get(t as usize))
        {
            let operands = [line[1], INPUT_ATTACHMENT_INDEX, *number];
            out.extend(instruction(DECORATE, &operands));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::translate;
    use etalon_scene::Shader;

    #[test]
    fn every_texel_is_read_from_subpass_data() {
        let reading = Shader::ALL
            .iter()
            .filter(|s| s.textures() > 0 && !s.samples_texture());
        for shader in reading {
            let words = translate(shader.name(), shader.wgsl())
                .expect("our own shader")
                .words;
            let changed = as_inputs(&words, [Some(Input::Numbered(3)), Some(Input::Unnumbered)]);
            let (header, found) = instructions(&changed);
            assert_eq!(header[3], words[3] + 1);
            let count = |code: u32| found.iter().filter(|line| line[0] & 0xffff == code).count();
            assert_eq!(count(IMAGE_FETCH), 0, "{}", shader.name());
            assert!(count(IMAGE_READ) >= shader.textures(), "{}", shader.name());
            let numbered = |line: &&&[u32]| {
                line[0] & 0xffff == DECORATE && line.ends_with(&[INPUT_ATTACHMENT_INDEX, 3])
            };
            assert_eq!(
                found.iter().filter(numbered).count(),
                1,
                "{}",
                shader.name()
            );
        }
    }
}
