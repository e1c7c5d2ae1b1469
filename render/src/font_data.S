// The font file as read-only bytes, rheo_font_begin up to rheo_font_end.
        .section .rodata
        .global rheo_font_begin
        .global rheo_font_end
        .balign 16
rheo_font_begin:
        .incbin RHEO_FONT_FILE
rheo_font_end:
        .byte 0
        .section .note.GNU-stack,"",%progbits
